#pragma once
#include "core/quantities.h"
#include "io/scenario/materials/form.h"

namespace asdic::detail::scenario {

/// A sediment by its mean grain size: a fluid.
struct GrainSizeForm {
  static constexpr std::string_view name = "grain-size";
  double size = 0.0, water_speed = 1500.0, water_density = 1000.0;

  void describe(Fields& field) {
    field(required("grain_size"), size,
          {.noun = "mean grain size", .unit = "phi", .low = -1.0, .high = 9.0}, "of the sediment");
    field(inherited("water_speed", "water.speed"), water_speed, quantity::sound_speed,
          "that the sediment's ratio refers to");
    field(inherited("water_density", "water.density"), water_density, quantity::density,
          "that the sediment's ratio refers to");
  }
  [[nodiscard]] FluidHalfSpace build(const MaterialPlace&) const {
    return sediment_of_grain_size(size, water_speed, water_density);
  }
};
static_assert(MaterialForm<GrainSizeForm>);

}  // namespace asdic::detail::scenario
