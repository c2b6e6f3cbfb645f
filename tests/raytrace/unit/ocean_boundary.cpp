#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/boundary.h"

namespace asdic::detail {
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

// A solid whose shear wave is infinitely slow is a fluid: the difference falls with (c_s/c₁)³.
TEST(Boundary, ASolidWithoutShearIsAFluid) {
  for (double grazing = 0.0; grazing < 1.57; grazing += 0.05) {
    const auto fluid = reflection_coefficient(
        FluidHalfSpace{.speed = 1800.0, .density = 2000.0, .attenuation_db_per_wavelength = 0.5},
        grazing, water);
    const auto solid = [&](double shear_speed) {
      return reflection_coefficient(ElasticHalfSpace{.speed = 1800.0,
                                                     .shear_speed = shear_speed,
                                                     .density = 2000.0,
                                                     .attenuation_db_per_wavelength = 0.5,
                                                     .shear_attenuation_db_per_wavelength = 1.0},
                                    grazing, water);
    };
    EXPECT_EQ(solid(0.0), fluid);
    EXPECT_NEAR(std::abs(solid(1.0) - fluid), 0.0, 1e-5);
    EXPECT_NEAR(std::abs(solid(0.1) - fluid), 0.0, 1e-7);
  }
}

// Beneath the shear wave's critical angle, arccos(c₁/c_s), a lossless solid reflects everything;
// above it, and below the compressional one, shear waves carry energy away.
TEST(Boundary, ShearOpensTheSolid) {
  const ElasticHalfSpace basalt = {.speed = 5250.0,
                                   .shear_speed = 2500.0,
                                   .density = 2700.0,
                                   .attenuation_db_per_wavelength = 0.0,
                                   .shear_attenuation_db_per_wavelength = 0.0};
  const double shear_critical = std::acos(1500.0 / 2500.0), critical = std::acos(1500.0 / 5250.0);
  for (double grazing = 0.01; grazing < shear_critical; grazing += 0.01)
    EXPECT_NEAR(std::abs(reflection_coefficient(basalt, grazing, water)), 1.0, 1e-13);
  const double between = 0.5 * (shear_critical + critical);
  EXPECT_LT(std::abs(reflection_coefficient(basalt, between, water)), 0.95);
  EXPECT_NEAR(std::abs(reflection_coefficient(basalt, critical, water)), 1.0, 1e-6);
  const double z1 = 1500.0 * 1000.0, z2 = 5250.0 * 2700.0;  // at the vertical no shear is excited
  EXPECT_NEAR(reflection_coefficient(basalt, pi / 2, water).real(), (z2 - z1) / (z2 + z1), 1e-14);
}

TEST(Boundary, TablesAreLinearInMagnitudeAndPhaseAndEndWithTheirRows) {
  const ReflectionTable table = {
      .grazing = {0.1, 0.5, 1.0}, .magnitude = {1.0, 0.5, 0.2}, .phase = {pi, 0.0, -0.4}};
  EXPECT_EQ(reflection_coefficient(table, 0.0999, water), 0.0);
  EXPECT_EQ(reflection_coefficient(table, 1.0001, water), 0.0);
  const auto middle = reflection_coefficient(table, 0.3, water);
  EXPECT_NEAR(std::abs(middle), 0.75, 1e-15);
  EXPECT_NEAR(std::arg(middle), pi / 2, 1e-15);
  EXPECT_NEAR(std::abs(reflection_coefficient(table, 1.0, water)), 0.2, 1e-15);
  EXPECT_NEAR(std::arg(reflection_coefficient(table, 1.0, water)), -0.4, 1e-15);
  EXPECT_EQ(reflection_coefficient(ReflectionTable{}, 0.3, water), 0.0);
}

}  // namespace
}  // namespace asdic::detail
