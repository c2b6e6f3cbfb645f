// Waves under a rough surface: each path loses once what a ray loses by roughness.
#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "raytrace/places/propagation_paths.h"

namespace asdic::detail {
namespace {

constexpr double f = 3500.0;

/// A shelf in winter: sound bends up and touches the surface again and again.
Environment shelf(double wind) {
  const std::vector<double> depth = {0.0, 40.0, 90.0, 180.0},
                            speed = {1482.0, 1482.4, 1486.0, 1487.0};
  Environment ocean{.water = SoundSpeedProfile::table(depth, speed, Interpolation::pchip)};
  ocean.bottom = {.depth = 180.0, .material = FluidHalfSpace{}};
  if (wind > 0.0)
    ocean.surface.roughness = {.rms_height = pierson_moskowitz_height(wind),
                               .sea_wind = wind,
                               .bubble_wind = wind > 1.0 ? wind : 0.0};
  return ocean;
}

Arrivals paths_at(double wind, double range, double depth) {
  const PropagationPaths paths(shelf(wind), {});
  return paths.find({0.0, 0.0, 5.0}, {range, 0.0, depth}, f,
                    {.max_surface_bounces = 8, .max_bottom_bounces = 8, .diffraction = true});
}

double intensity(const Arrivals& paths) {
  double sum = 0.0;
  for (const Arrival& a : paths) sum += std::norm(a.amplitude) + a.scattered;
  return sum;
}

// Each path is that of the smooth sea less the losses of its own bounces, by the formulae of one
// bounce: e^{−p/2} for the mean field, and the energy that bubbles leave. It was up to 153 dB
// louder.
TEST(RoughWaves, LoseWhatRaysLose) {
  int waves = 0;
  for (const double range : {3000.0, 6000.0, 12945.7})
    for (const double depth : {20.0, 54.25, 120.0}) {
      const Arrivals smooth = paths_at(0.0, range, depth);
      for (const double wind : {3.0, 7.0, 12.25, 18.0}) {
        const Arrivals rough = paths_at(wind, range, depth);
        const Roughness sea = shelf(wind).surface.roughness;
        std::size_t i = 0;
        for (const Arrival& a : rough) {
          if (a.kind == ArrivalKind::diffracted) continue;
          while (i < smooth.size() && smooth[i].delay != a.delay) ++i;
          ASSERT_LT(i, smooth.size());
          const double cosine = 1482.0 * a.horizontal_slowness;
          const RoughReflection one =
              rough_reflection(sea, std::sqrt(1.0 - cosine * cosine), 2.0 * pi * f / 1482.0);
          const double mean = std::pow(one.coherent, a.surface_bounces),
                       energy = std::pow(one.energy, a.surface_bounces);
          const double whole = std::norm(smooth[i].amplitude);
          EXPECT_NEAR(std::abs(a.amplitude), std::sqrt(whole) * mean, 1e-6 * std::sqrt(whole));
          EXPECT_NEAR(std::norm(a.amplitude) + a.scattered, whole * energy, 1e-6 * whole);
          waves += a.kind == ArrivalKind::caustic;
        }
      }
    }
  EXPECT_GT(waves, 100);
}

// Sound decreases with the wind, and without wind it is that of the smooth sea. (The law of bubbles
// has no such limit; a calm sea has no bubbles.)
TEST(RoughWaves, FallWithTheWind) {
  for (const double range : {3000.0, 12945.7}) {
    double before = intensity(paths_at(0.0, range, 54.25));
    EXPECT_NEAR(intensity(paths_at(1e-3, range, 54.25)), before, 1e-6 * before);
    for (const double wind : {2.0, 5.0, 8.0, 12.0, 15.0, 20.0}) {
      const double now = intensity(paths_at(wind, range, 54.25));
      EXPECT_LE(now, before * (1.0 + 1e-9)) << wind;
      before = now;
    }
  }
}

}  // namespace
}  // namespace asdic::detail
