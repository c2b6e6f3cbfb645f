#include "raytrace/ocean/tube_amplitude.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

// In water of one speed a straight way of length s spreads over a sphere, whichever formula tells
// how: q = s, r = s·cos α, ∫c ds = cs. Five roundings, and the cosine's.
TEST(TubeAmplitude, IsOneOverTheDistance) {
  constexpr double c = 1500.0;
  for (const double elevation : {-1.4, -0.3, 0.0, 0.8})
    for (const double distance : {2.0, 370.0, 4e4}) {
      const RayTube tube{.speed = c,
                         .q = -distance,
                         .range = distance * std::cos(elevation),
                         .launch_slowness = launch_slowness(elevation, c),
                         .speed_integral = c * distance};
      EXPECT_NEAR(tube_amplitude(Spreading::plane, tube) * distance, 1.0, 1e-15);
      EXPECT_NEAR(tube_amplitude(Spreading::cylindrical, tube) * distance, 1.0, 1e-15);
    }
}

// Two rays meet at a fold, r = r_c + ½r″x² and τ = τ_c + ξ_c(r − r_c) + ⅓r″x³ with x = ξ − ξ_c
// (dτ = ξ dr): the two of one range, x and −x, are Δτ = ⅔r″x³ apart. Where Airy's argument
// (3ωΔτ/4)^⅔ is 0.307, |dr/dξ| = r″x is the floor.
TEST(AiryFloor, IsTheSlopeWhereAirysArgumentIsThree10ths) {
  for (const double curvature : {3e9, 4e12})
    for (const double frequency : {50.0, 4000.0}) {
      const auto argument = [&](double x) {
        return std::pow(0.75 * 2.0 * pi * frequency * 2.0 / 3.0 * curvature * x * x * x, 2.0 / 3.0);
      };
      double low = 0.0, high = 1.0;
      for (int i = 0; i < 200; ++i)
        (argument(0.5 * (low + high)) < 0.307 ? low : high) = 0.5 * (low + high);
      EXPECT_NEAR(airy_floor(curvature, frequency) / (curvature * low), 1.0, 1e-13);
    }
}

// A quarter of a turn each, and back again.
TEST(PathAmplitude, IsTheProductOfItsFactors) {
  const Complex i(0.0, 1.0), reflection(-0.3, 0.4);
  Complex phase = std::pow(i, -5);
  for (int caustics = -5; caustics <= 5; ++caustics, phase *= i) {
    EXPECT_NEAR(std::abs(caustic_phase(caustics) - phase), 0.0, 1e-14);
    EXPECT_NEAR(
        std::abs(path_amplitude(1e-3, 0.5, reflection, caustics) - 0.5e-3 * reflection * phase),
        0.0, 1e-17);
  }
  EXPECT_NEAR(scattered_power(1e-3, 0.5, 0.2), 0.5e-7, 1e-22);
}

}  // namespace
}  // namespace asdic::detail
