#include "sonar/paths/moving_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "raytrace/paths/eigenrays.h"
#include "raytrace/places/propagation_paths.h"

namespace asdic::detail {
namespace {

/// A thermocline of 0.3 m/s a metre under a mixed layer.
EigenraySolver thermocline() {
  Environment ocean;
  const std::array<double, 4> depth = {0.0, 50.0, 150.0, 4000.0};
  const std::array<double, 4> speed = {1520.0, 1520.0, 1490.0, 1555.0};
  ocean.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  ocean.bottom = {.depth = 4000.0, .material = FluidHalfSpace{}};
  return EigenraySolver(ocean);
}

bool same_history(const Arrival& a, const Arrival& b) {
  return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
         a.upper_turns == b.upper_turns && a.lower_turns == b.lower_turns &&
         a.caustics == b.caustics;
}

/// The path after the source has sunk from z by `sunk` in steps so small that its delay and its
/// launch angle, which then change by little, resolve it; none if it ends on the way.
std::optional<Arrival> followed(const EigenraySolver& sea, Arrival path, double z, double sunk,
                                double receiver, double range, const PathLimits& limits) {
  constexpr int steps = 100;
  for (int i = 1; i <= steps; ++i) {
    const Arrivals now = sea.find(z + sunk * i / steps, receiver, range, 3000.0, limits);
    const Arrival* next = nullptr;
    double least = 1.0;
    for (const Arrival& a : now) {
      const double strange = std::abs(a.delay - path.delay) / 1e-4 +  // 15 cm
                             std::abs(a.launch_elevation - path.launch_elevation) / radians(1.0);
      if (same_history(a, path) && strange < least) least = strange, next = &a;
    }
    if (next == nullptr) return std::nullopt;
    path = *next;
  }
  return path;
}

// The source sinks by 3 m: its speed of sound falls by 0.9 m/s, so that a ray that left level
// leaves under acos(1 − 6e-4) = 2°, and was lost when launch angles within a degree were asked for.
// Its horizontal slowness has changed by no more than 2e-4. None may be lost, or taken for another.
TEST(SamePath, IsTheOneOfTheSameSlownessWhereALevelRayTurns) {
  const EigenraySolver sea = thermocline();
  const PathLimits limits{.max_surface_bounces = 1, .max_bottom_bounces = 1};
  int followable = 0, turned_far = 0;
  for (const double z : {110.0, 120.0, 130.0, 140.0})
    for (const double receiver : {200.0, 400.0})
      for (double range = 4000.0; range < 20000.0; range += 1500.0) {
        const Arrivals before = sea.find(z, receiver, range, 3000.0, limits);
        const Arrivals after = sea.find(z + 3.0, receiver, range, 3000.0, limits);
        for (const Arrival& path : before) {
          const auto truth = followed(sea, path, z, 3.0, receiver, range, limits);
          if (!truth) continue;
          ++followable;
          const Arrival* found = same_path(after, path, true);
          ASSERT_NE(found, nullptr) << z << ' ' << receiver << ' ' << range;
          EXPECT_EQ(found->delay, truth->delay) << z << ' ' << receiver << ' ' << range;
          if (std::abs(truth->launch_elevation - path.launch_elevation) < radians(1.0)) continue;
          ++turned_far;
          // The angle is all there is if speed varies with range.
          if (const Arrival* by_angle = same_path(after, path, false); by_angle != nullptr) {
            EXPECT_EQ(by_angle->delay, truth->delay) << z << ' ' << receiver << ' ' << range;
          }
        }
      }
  EXPECT_GT(followable, 300);
  EXPECT_GE(turned_far, 8);
}

// In a duct, paths of one history leave upwards and downwards with almost the same slowness; sign
// and slowness resolve them. In open water the direct path passes through the level, and there
// the sign must not matter.
TEST(SamePath, KeepsUpAndDownApartButNotAtTheLevel) {
  const double c = 1500.0;
  const auto path = [&](double elevation) {
    Arrival a;
    a.launch_elevation = radians(elevation);
    a.horizontal_slowness = std::cos(radians(elevation)) / c;
    return a;
  };
  const Arrivals pair = {path(5.0), path(-5.1)};
  EXPECT_EQ(same_path(pair, path(5.08), true), &pair[0]);
  EXPECT_EQ(same_path(pair, path(-5.02), true), &pair[1]);
  const Arrivals almost_level = {path(0.6), path(-0.3)};
  EXPECT_EQ(same_path(almost_level, path(0.3), true), &almost_level[0]);
  const Arrivals level = {path(-0.2)};
  EXPECT_EQ(same_path(level, path(0.3), true), &level[0]);
  EXPECT_EQ(same_path(level, path(30.0), true), nullptr);
}

/// A shelf in summer, where a third of the rays have the amplitude of waves.
Environment summer_shelf() {
  Environment ocean;
  const std::array<double, 5> depth = {0.0, 20.0, 35.0, 60.0, 120.0};
  const std::array<double, 5> speed = {1521.0, 1520.0, 1501.0, 1494.0, 1493.0};
  ocean.water = SoundSpeedProfile::table(depth, speed, Interpolation::pchip);
  ocean.bottom = {.depth = 120.0, .material = FluidHalfSpace{.speed = 1650.0, .density = 1900.0}};
  return ocean;
}

// Amplitudes of waves come from legs at ranges of a grid; those found at the very place are the
// measure: 1 % of the leg for all its paths together.
TEST(FollowedPaths, HaveTheAmplitudesThatAreFoundAtTheirPlace) {
  const PropagationPaths paths(summer_shelf(), {});
  constexpr double frequency = 3500.0;
  const PathLimits limits{.max_surface_bounces = 3, .max_bottom_bounces = 4, .diffraction = true};
  const Vec3 from(0.0, 0.0, 60.0);
  Arrivals known = paths.find(from, {0.0, 5000.0, 80.0}, frequency, limits);
  const auto by_waves = std::count_if(known.begin(), known.end(), [](const Arrival& path) {
    return path.kind == ArrivalKind::caustic;
  });
  ASSERT_GT(by_waves, 5);
  for (const double range : {5000.3, 5001.0, 5003.7, 5009.2, 5014.9}) {
    const Vec3 to(0.0, range, 80.0);
    known = paths.follow(known, from, to, frequency, limits);
    const Arrivals there = paths.find(from, to, frequency, limits);
    double off = 0.0, all = 0.0;
    for (const Arrival& path : there) {
      const Arrival* same = same_path(known, path, true);
      const std::complex<double> amplitude = same != nullptr ? same->amplitude : 0.0;
      all += std::norm(path.amplitude);
      off += std::norm(amplitude - path.amplitude);
      if (same != nullptr && std::norm(path.amplitude) > 1e-4 * all) {
        EXPECT_NEAR(same->delay, path.delay, 2e-7) << range;
      }
    }
    EXPECT_LT(std::sqrt(off / all), 0.01) << range;
  }
}

// A target turns back just after the direct path has reached it, at a time at which straight sound
// of the source's speed would still be on its way. In water of one gradient g the delay between two
// places d apart is acosh(1 + g²d²/(2c₁c₂))/g.
TEST(MovingPaths, AreMetBeforeATurnThatStraightSoundWouldMiss) {
  constexpr double g = 0.1, top = 1500.0, depth = 400.0, frequency = 1000.0;
  Environment ocean;
  const std::array<double, 2> at = {0.0, 500.0}, speed = {top, top + 500.0 * g};
  ocean.water = SoundSpeedProfile::table(at, speed, Interpolation::c_linear);
  ocean.bottom = {.depth = 500.0, .material = FluidHalfSpace{}};
  const PropagationPaths paths(ocean, {});
  const Vec3 from(0.0, 0.0, 10.0), begin(2000.0, 0.0, depth), velocity(10.0, 0.0, 0.0);
  const auto delay = [&](const Vec3& to) {
    return std::acosh(1.0 + g * g * (to - from).squaredNorm() /
                                (2.0 * (top + g * from.z()) * (top + g * to.z()))) /
           g;
  };
  double time = 0.0;
  for (int i = 0; i < 20; ++i) time = delay(begin + time * velocity);
  const double turn = time + 1e-3;
  Track track;
  track.waypoints = {{.time = 0.0, .position = begin},
                     {.time = turn, .position = begin + turn * velocity},
                     {.time = turn + 100.0, .position = begin + (turn - 100.0) * velocity}};
  const MovingPaths moving(paths, {.max_surface_bounces = 0, .max_bottom_bounces = 0}, frequency,
                           0.0);
  const Way way = moving.way(from, 0.0, track, Vec3::Zero());
  ASSERT_EQ(way.leg.arrivals.size(), 1U);
  const MetPath met = moving.meet(from, 0.0, track, Vec3::Zero(), way, way.leg.arrivals.front());
  EXPECT_NEAR(met.time, time, 1e-7);
  EXPECT_NEAR((met.way.end.velocity - velocity).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace asdic::detail
