#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/boundary.h"
#include "support/csv.h"

namespace asdic {
namespace {

FluidHalfSpace fluid_of(const support::Csv& csv, std::size_t row) {
  return {.speed = csv["c2"][row],
          .density = csv["rho2"][row],
          .attenuation_db_per_wavelength = csv["alpha_dB_lambda"][row]};
}

// The table uses e^{−iωt}: ours is its conjugate. It prints ten significant digits of R and of the
// loss, which reaches 12.5 dB.
TEST(Boundary, RayleighCoefficient) {
  const support::Csv csv("physics-reference/boundary.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const WaterAtBoundary water = {.speed = csv["c1"][row], .density = csv["rho1"][row]};
    const auto r =
        reflection_coefficient(fluid_of(csv, row), radians(csv["grazing_deg"][row]), water);
    EXPECT_NEAR(r.real(), csv["R_re"][row], 1e-9) << row;
    EXPECT_NEAR(-r.imag(), csv["R_im"][row], 1e-9) << row;
    EXPECT_NEAR(-db_from_amplitude(std::abs(r)), csv["loss_dB"][row], 1e-8) << row;
  }
}

}  // namespace
}  // namespace asdic
