#include "raytrace/ocean/beam_displacement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr double frequency = 300.0;
constexpr WaterAtBoundary water{.speed = 1500.0, .density = 1000.0};

std::vector<BoundaryMaterial> bottoms() {
  return {FluidHalfSpace{.speed = 1700.0, .density = 1800.0, .attenuation_db_per_wavelength = 0.0},
          FluidHalfSpace{},
          FluidHalfSpace{.speed = 1450.0, .density = 1400.0, .attenuation_db_per_wavelength = 0.3},
          ElasticHalfSpace{},
          ElasticHalfSpace{.speed = 3500.0,
                           .shear_speed = 1800.0,
                           .density = 2500.0,
                           .attenuation_db_per_wavelength = 0.0,
                           .shear_attenuation_db_per_wavelength = 0.0},
          ReflectionTable{.grazing = {0.0, 0.3, 0.9, 1.6},
                          .magnitude = {1.0, 0.9, 0.5, 0.4},
                          .phase = {3.1, 1.8, 1.0, -0.4}}};
}

// Δ = ∂φ/∂k_t, k_t = ω·cos θ/c, by central differences of the coefficient itself. Steps of 1e-5
// rad: h²/6 of the third derivative, 1e-6 of Δ away from critical angles (28.07°, 0.42 rad and
// others; the angles below keep 0.02 rad from them), and rounding of 1e-16/1e-5.
TEST(BeamDisplacement, IsTheDerivativeOfThePhase) {
  constexpr double h = 1e-5;
  for (const BoundaryMaterial& bottom : bottoms())
    for (const double grazing : {0.05, 0.2, 0.35, 0.55, 0.8, 1.1, 1.4}) {
      const auto r = [&](double angle) { return reflection_coefficient(bottom, angle, water); };
      const auto k = [&](double angle) {
        return 2.0 * pi * frequency * std::cos(angle) / water.speed;
      };
      const double phase = std::arg(r(grazing + h) / r(grazing - h));
      const double expected = phase / (k(grazing + h) - k(grazing - h));
      const BeamDisplacement moved = beam_displacement(bottom, grazing, water, frequency);
      EXPECT_NEAR(moved.length, expected, 1e-5 * (std::abs(expected) + 0.1))
          << bottom.index() << " at " << grazing;
    }
}

// Its own derivatives, by central differences of the displacement.
TEST(BeamDisplacement, KnowsHowItVaries) {
  constexpr double h = 1e-5;
  for (const BoundaryMaterial& bottom : bottoms())
    for (const double grazing : {0.05, 0.2, 0.35, 0.55, 0.8, 1.1, 1.4}) {
      const auto length = [&](double angle, double c) {
        return beam_displacement(bottom, angle, {.speed = c, .density = 1000.0}, frequency).length;
      };
      const BeamDisplacement moved = beam_displacement(bottom, grazing, water, frequency);
      const double angle = (length(grazing + h, 1500.0) - length(grazing - h, 1500.0)) / (2.0 * h);
      const double speed = (length(grazing, 1500.1) - length(grazing, 1499.9)) / 0.2;
      SCOPED_TRACE(testing::Message() << bottom.index() << " at " << grazing);
      EXPECT_NEAR(moved.per_grazing, angle, 1e-5 * (std::abs(angle) + 1.0));
      EXPECT_NEAR(moved.per_speed, speed, 1e-3 * std::abs(speed) + 1e-6);
    }
}

// A lossless fluid below its critical angle: φ = 2·atan(b/a), a = m·sin θ, b = √(cos²θ − n²);
// Brekhovskikh & Lysanov. Almost along the boundary, Δ·tan θ/2 = m/(k·√(1 − n²)), the depth of the
// pressure-release surface that the bottom looks like.
TEST(BeamDisplacement, OfAFluidInClosedForm) {
  const FluidHalfSpace sand{
      .speed = 1700.0, .density = 1800.0, .attenuation_db_per_wavelength = 0.0};
  const double k = 2.0 * pi * frequency / 1500.0, n = 1500.0 / 1700.0, m = 1.8;
  for (const double grazing : {0.01, 0.1, 0.3, 0.45}) {
    const double s = std::sin(grazing), c = std::cos(grazing);
    const double a = m * s, b = std::sqrt(c * c - n * n);
    const double slope = 2.0 * (-c * s / b * a - m * c * b) / (a * a + b * b);  // dφ/dθ
    EXPECT_NEAR(beam_displacement(sand, grazing, water, frequency).length, -slope / (k * s), 1e-10);
  }
  const double grazing = 1e-4;
  const double depth =
      0.5 * beam_displacement(sand, grazing, water, frequency).length * std::tan(grazing);
  EXPECT_NEAR(depth, m / (k * std::sqrt(1.0 - n * n)), 1e-6);
}

TEST(BeamDisplacement, IsNoneWhereThePhaseIsConstant) {
  for (const BoundaryMaterial& wall : {BoundaryMaterial{Vacuum{}}, BoundaryMaterial{Rigid{}}})
    for (const double grazing : {0.0, 0.4, 1.5}) {
      const BeamDisplacement moved = beam_displacement(wall, grazing, water, frequency);
      EXPECT_EQ(moved.length, 0.0);
      EXPECT_EQ(moved.per_grazing, 0.0);
    }
}

// At the critical angle itself and along the boundary the formulas are 0/0 or 1/0: finite answers.
TEST(BeamDisplacement, IsFiniteEverywhere) {
  for (const BoundaryMaterial& bottom : bottoms())
    for (const double grazing : {0.0, 1e-300, std::acos(1500.0 / 1700.0), 0.5 * pi}) {
      const BeamDisplacement moved = beam_displacement(bottom, grazing, water, frequency);
      EXPECT_TRUE(std::isfinite(moved.length) && std::isfinite(moved.per_grazing) &&
                  std::isfinite(moved.per_speed));
    }
}

}  // namespace
}  // namespace asdic::detail
