// Round waves off the boundaries, path by path.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "raytrace/places/propagation_paths.h"

namespace asdic::detail {
namespace {

constexpr double speed = 1500.0, depth = 100.0, source = 40.0, receiver = 65.0, range = 5000.0;

Environment guide(BoundaryMaterial floor) {
  Environment ocean{.water = SoundSpeedProfile::isovelocity(speed), .water_density = 1000.0};
  ocean.bottom = {.depth = depth, .material = std::move(floor)};
  return ocean;
}

Arrivals paths_of(const Environment& ocean, double frequency, int bounces) {
  const PathLimits limits{
      .max_surface_bounces = bounces, .max_bottom_bounces = bounces, .diffraction = true};
  return PropagationPaths(ocean, {}).find({0.0, 0.0, source}, {range, 0.0, receiver}, frequency,
                                          limits);
}

// Ten metres of a floor like the water over one that does not move: the sea is 110 m deep, and
// every path of n bounces off the floor is that of an image 20·n m further away. The reflection at
// the ray's own angle has its phase to the first order of those 20·n m; the second, k·(20·n)²/2r,
// is 0.6 rad for n = 6. A ray that is within 0.1 % of the leg stays one.
TEST(BranchWaves, OffAFloorLikeTheWaterAreThoseOfADeeperSea) {
  constexpr double thickness = 10.0;
  const FloorLayer water{.thickness = thickness,
                         .speed = speed,
                         .density = 1000.0,
                         .attenuation_db_per_wavelength = 0.0},
      rigid{.speed = speed, .density = 1e12, .attenuation_db_per_wavelength = 0.0};
  const Environment ocean = guide(LayeredFloor{.layers = {water}, .below = rigid});
  for (const double f : {60.0, 200.0}) {
    const double k = 2.0 * pi * f / speed;
    const Arrivals paths = paths_of(ocean, f, 6);
    EXPECT_GE(paths.size(), 24U);
    double leg = 0.0, furthest_by_rays = 0.0;
    for (const Arrival& path : paths) leg += std::norm(path.amplitude);
    for (const Arrival& path : paths) {
      const double rise = std::sqrt(
                       std::max(0.0, path.path_length * path.path_length - range * range)),
                   length = std::hypot(range, rise + 2.0 * thickness * path.bottom_bounces);
      const double sign = path.surface_bounces % 2 == 0 ? 1.0 : -1.0;
      const std::complex<double> truth = std::polar(sign / length, -k * length),
                                 got = path.amplitude * std::polar(1.0, -2.0 * pi * f * path.delay),
                                 ray = path.reflection / path.path_length *
                                       std::polar(1.0, -k * path.path_length);
      EXPECT_LT(std::abs(got - truth), 1.2e-3 * std::sqrt(leg))
          << f << " Hz, " << path.surface_bounces << " and " << path.bottom_bounces << " bounces";
      furthest_by_rays = std::max(furthest_by_rays, std::abs(ray - truth) * range);
    }
    EXPECT_GT(furthest_by_rays, 0.1);  // of a path
  }
}

// Where all angles are reflected alike, and where waves are short, rays are right, and stay rays.
TEST(BranchWaves, LeaveRaysThatAreRight) {
  const FluidHalfSpace sand{
      .speed = 1600.0, .density = 1800.0, .attenuation_db_per_wavelength = 0.5};
  for (const Arrival& path : paths_of(guide(Rigid{}), 100.0, 6))
    EXPECT_EQ(path.kind, ArrivalKind::ray);
  for (const Arrival& path : paths_of(guide(sand), 10000.0, 10))
    EXPECT_EQ(path.kind, ArrivalKind::ray);
  int waves = 0;
  for (const Arrival& path : paths_of(guide(sand), 100.0, 10))
    waves += path.kind == ArrivalKind::caustic ? 1 : 0;
  EXPECT_GT(waves, 30);
}

}  // namespace
}  // namespace asdic::detail
