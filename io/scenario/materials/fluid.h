#pragma once
#include "core/quantities.h"
#include "io/scenario/materials/form.h"
#include "io/scenario/materials/loss.h"

namespace asdic::detail::scenario {

/// A homogeneous fluid.
struct FluidForm {
  static constexpr std::string_view name = FluidHalfSpace::name;
  FluidHalfSpace fluid = {};

  void describe(Fields& field) {
    field("speed", fluid.speed, quantity::sound_speed, "of sound in it");
    constexpr double fastest_gas = 500.0;  // air above ice or water is no slip [m/s]
    Quantity density = quantity::density;
    if (fluid.speed < fastest_gas) density.low = 0.1;
    field("density", fluid.density, density, "of it");
    describe_loss(field, false, fluid.speed, fluid.attenuation_db_per_wavelength);
  }
  [[nodiscard]] FluidHalfSpace build(const MaterialPlace&) const { return fluid; }
  [[nodiscard]] static FluidForm of(const FluidHalfSpace& made) { return {made}; }
};
static_assert(FormOf<FluidForm, FluidHalfSpace>);

}  // namespace asdic::detail::scenario
