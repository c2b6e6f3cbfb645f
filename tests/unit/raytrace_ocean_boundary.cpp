#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/boundary.h"

namespace asdic {
namespace {

constexpr WaterAtBoundary water = {.speed = 1500.0, .density = 1000.0};
constexpr FluidHalfSpace fast = {
    .speed = 1800.0, .density = 2000.0, .attenuation_db_per_wavelength = 0.0};

TEST(Boundary, PressureReleaseAndRigid) {
  for (const double grazing : {0.0, 0.3, pi / 2}) {
    EXPECT_EQ(reflection_coefficient(Vacuum{}, grazing, water), -1.0);
    EXPECT_EQ(reflection_coefficient(Rigid{}, grazing, water), 1.0);
  }
}

// A lossless faster fluid reflects everything below the critical angle, arccos(c₁/c₂) = 33.56°,
// with a phase that rises from −180° at grazing to 0 at critical: s = −i|s| for e^{+iωt}, so
// R = (a + i|s|)/(a − i|s|), phase 2·atan2(|s|, a) > 0.
TEST(Boundary, TotalReflectionBelowCritical) {
  const double critical = std::acos(water.speed / fast.speed);
  double before = pi;
  for (double grazing = 0.01; grazing < critical; grazing += 0.01) {
    const auto r = reflection_coefficient(fast, grazing, water);
    EXPECT_NEAR(std::abs(r), 1.0, 1e-14);
    const double n = water.speed / fast.speed;
    const double s = std::sqrt(std::pow(std::cos(grazing), 2) - n * n);
    EXPECT_NEAR(std::arg(r), 2.0 * std::atan2(s, 2.0 * std::sin(grazing)), 1e-12);
    EXPECT_LT(std::arg(r), before);
    before = std::arg(r);
  }
  EXPECT_LT(std::abs(reflection_coefficient(fast, critical + 0.01, water)), 0.99);
}

// At normal incidence only the impedances count: (Z₂ − Z₁)/(Z₂ + Z₁).
TEST(Boundary, NormalIncidence) {
  const double z1 = 1500.0 * 1000.0, z2 = 1800.0 * 2000.0;
  const auto r = reflection_coefficient(fast, pi / 2, water);
  EXPECT_NEAR(r.real(), (z2 - z1) / (z2 + z1), 1e-14);
  EXPECT_NEAR(r.imag(), 0.0, 1e-14);
}

// Sound does not notice a boundary between equal waters, and at grazing incidence everything turns
// with the opposite sign.
TEST(Boundary, LimitsOfTheFluid) {
  const FluidHalfSpace same = {
      .speed = 1500.0, .density = 1000.0, .attenuation_db_per_wavelength = 0.0};
  EXPECT_NEAR(std::abs(reflection_coefficient(same, 0.4, water)), 0.0, 1e-14);
  EXPECT_NEAR(std::abs(reflection_coefficient(fast, 0.0, water) + 1.0), 0.0, 1e-14);
}

// Equal speeds: at zero grazing both terms of R vanish together; still a number, the limit.
TEST(Boundary, IsFiniteWhereBothTermsVanish) {
  const FluidHalfSpace same = {
      .speed = 1500.0, .density = 1000.0, .attenuation_db_per_wavelength = 0.0};
  EXPECT_EQ(reflection_coefficient(same, 0.0, water), -1.0);
}

}  // namespace
}  // namespace asdic
