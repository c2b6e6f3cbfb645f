#pragma once
#include "core/quantities.h"
#include "io/scenario/materials/form.h"
#include "io/scenario/materials/loss.h"

namespace asdic::detail::scenario {

/// A solid that carries shear waves.
struct ElasticForm {
  static constexpr std::string_view name = ElasticHalfSpace::name;
  ElasticHalfSpace solid = {};

  void describe(Fields& field) {
    field("speed", solid.speed, quantity::sound_speed, "of compressional waves");
    field("shear_speed", solid.shear_speed, shear_speed_quantity, "of shear waves");
    field("density", solid.density, quantity::density, "of it");
    describe_loss(field, false, solid.speed, solid.attenuation_db_per_wavelength);
    describe_loss(field, true, solid.shear_speed, solid.shear_attenuation_db_per_wavelength);
  }
  [[nodiscard]] ElasticHalfSpace build(const MaterialPlace& place) const;
  [[nodiscard]] static ElasticForm of(const ElasticHalfSpace& made) { return {made}; }
};
static_assert(FormOf<ElasticForm, ElasticHalfSpace>);

}  // namespace asdic::detail::scenario
