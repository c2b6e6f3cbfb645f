#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/absorption.h"
#include "raytrace/ocean/boundary.h"

namespace asdic::detail {
namespace {

double between(double low, double high) {
  constexpr int steps = 1'000'000;
  return low + (high - low) * *rc::gen::inRange(0, steps + 1) / steps;
}

// No passive bottom gives back more than it gets.
RC_GTEST_PROP(Boundary, NeverReflectsMoreThanComesIn, ()) {
  const FluidHalfSpace fluid = {.speed = between(300.0, 6000.0),
                                .density = between(1.0, 8000.0),
                                .attenuation_db_per_wavelength = between(0.0, 3.0)};
  const WaterAtBoundary water = {.speed = between(1400.0, 1600.0),
                                 .density = between(990.0, 1060.0)};
  const auto r = reflection_coefficient(fluid, between(0.0, pi / 2), water);
  RC_ASSERT(std::isfinite(r.real()) && std::isfinite(r.imag()));
  RC_ASSERT(std::abs(r) <= 1.0 + 1e-13);
}

// Nor does a passive solid: one whose bulk and shear moduli both take energy,
// α_p·c_p² ≥ (4/3)·α_s·c_s², and whose bulk modulus is positive, c_p² > (4/3)·c_s².
RC_GTEST_PROP(Boundary, SolidsNeverReflectMoreThanComesIn, ()) {
  ElasticHalfSpace solid = {.speed = between(300.0, 6000.0),
                            .shear_speed = 0.0,
                            .density = between(300.0, 8000.0),
                            .attenuation_db_per_wavelength = between(0.0, 3.0),
                            .shear_attenuation_db_per_wavelength = 0.0};
  const double ratio = between(0.0, 0.866);  // c_s/c_p, at most √(3/4)
  solid.shear_speed = ratio * solid.speed;
  const double most = solid.attenuation_db_per_wavelength * 0.75 / (ratio * ratio + 1e-12);
  solid.shear_attenuation_db_per_wavelength = between(0.0, 1.0) * std::min(most, 5.0);
  const WaterAtBoundary water = {.speed = between(1400.0, 1600.0),
                                 .density = between(990.0, 1060.0)};
  const auto r = reflection_coefficient(solid, between(0.0, pi / 2), water);
  RC_ASSERT(std::isfinite(r.real()) && std::isfinite(r.imag()));
  RC_ASSERT(std::abs(r) <= 1.0 + 1e-11);
}

// Every relaxation adds its share: absorption is positive and rises with frequency.
RC_GTEST_PROP(Absorption, RisesWithFrequency, ()) {
  const FrancoisGarrison water = {.temperature = between(-2.0, 30.0),
                                  .salinity = between(0.0, 40.0),
                                  .ph = between(7.5, 8.5),
                                  .depth = between(0.0, 6000.0)};
  const double f = between(10.0, 1e5);
  for (const Absorption& law : {Absorption(water), Absorption(Thorp{})}) {
    RC_ASSERT(absorption_db_per_km(law, f) > 0.0);
    RC_ASSERT(absorption_db_per_km(law, 1.01 * f) > absorption_db_per_km(law, f));
  }
}

}  // namespace
}  // namespace asdic::detail
