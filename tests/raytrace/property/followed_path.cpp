#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/units.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {
namespace {

/// Random water: Munk's law, or a table of 4 to 30 samples that falls and rises again, wobbling,
/// under any rule; over sand, rock or nothing that lets sound in.
Environment random_ocean(std::mt19937& random) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution(a, b)(random);
  };
  Environment ocean;
  const double bottom = uniform(300.0, 5500.0);
  ocean.bottom = {.depth = bottom, .material = FluidHalfSpace{}};
  if (uniform(0.0, 1.0) < 0.3) ocean.bottom.material = Rigid{};
  ocean.absorption = Thorp{};
  const int kind = std::uniform_int_distribution(0, 5)(random);
  if (kind == 5) {
    ocean.water = SoundSpeedProfile::munk();
    return ocean;
  }
  constexpr std::array rules = {Interpolation::c_linear, Interpolation::n2_linear,
                                Interpolation::spline, Interpolation::pchip,
                                Interpolation::pchip_spline_slopes};
  const int n = std::uniform_int_distribution(4, 30)(random);
  std::vector<double> depth, speed;
  const double axis = uniform(0.1, 0.7) * bottom, scale = uniform(0.2, 0.5) * bottom;
  for (int i = 0; i < n; ++i) {
    depth.push_back(bottom * i / (n - 1.0));
    const double x = (depth.back() - axis) / scale;
    speed.push_back(1490.0 + 8.0 * (x - 1.0 + std::exp(-x)) + uniform(-0.5, 0.5));
  }
  ocean.water = SoundSpeedProfile::table(depth, speed, rules[static_cast<std::size_t>(kind)]);
  return ocean;
}

bool same_history(const Arrival& a, const Arrival& b) {
  return (a.launch_elevation > 0.0) == (b.launch_elevation > 0.0) &&
         a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
         a.upper_turns == b.upper_turns && a.lower_turns == b.lower_turns;
}

/// The one of its history whose Snell invariant is nearest: which path a path has become. (Launch
/// angles change with the source's depth, too; next to a smooth maximum of the speed there are rays
/// of the same history, of 1e-10 of the amplitude, closer than that.)
const Arrival* nearest(const Arrivals& all, const Arrival& path) {
  const auto away = [&](const Arrival& a) {
    return std::abs(a.horizontal_slowness - path.horizontal_slowness);
  };
  const Arrival* best = nullptr;
  for (const Arrival& a : all)
    if (same_history(a, path) && (best == nullptr || away(a) < away(*best))) best = &a;
  return best;
}

// Both ends move by up to 20 m, as they do within a pulse, or by up to 200 m, as during a travel
// time. What is followed is what a search finds there: the delay to 1e-9 s (both roots miss by less
// than 0.01 mm, corrected to first order, so that rounding is left), the angle to 1e-7 rad and the
// amplitude, a derivative, to 1e-5 of it away from caustics. What cannot be followed is searched
// for; that has to be rare, or nothing is gained: less than one path in ten.
TEST(FollowedPath, IsThePathThatASearchFinds) {
  std::mt19937 random(20261121);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution(a, b)(random);
  };
  const PathLimits limits{.max_surface_bounces = 2, .max_bottom_bounces = 2};
  int followed = 0, near_followed = 0, near_all = 0, all = 0;
  for (int ocean_number = 0; ocean_number < 60; ++ocean_number) {
    const Environment ocean = random_ocean(random);
    const EigenraySolver solver(ocean);
    const double bottom = ocean.bottom.depth;
    for (int i = 0; i < 6; ++i) {
      const double range = std::exp(uniform(std::log(500.0), std::log(50e3)));
      const double source = uniform(0.02, 0.98) * bottom, receiver = uniform(0.02, 0.98) * bottom;
      const bool near = i % 2 == 0;
      const double most = near ? 20.0 : 200.0;
      const bool level = i % 3 == 0;  // both keep their depths
      const auto moved = [&](double z) {
        return level ? z : std::clamp(z + 0.1 * uniform(-most, most), 1.0, bottom - 1.0);
      };
      const double to_range = std::max(100.0, range + uniform(-most, most)),
                   to_source = moved(source), to_receiver = moved(receiver);
      const Arrivals before = solver.find(source, receiver, range, 1000.0, limits);
      const Arrivals after = solver.find(to_source, to_receiver, to_range, 1000.0, limits);
      for (const Arrival& path : before) {
        ++all;
        near_all += near;
        const auto same = solver.follow(path, to_source, to_receiver, to_range, 1000.0, limits);
        if (!same) continue;
        ++followed;
        near_followed += near;
        const Arrival* searched = nearest(after, path);
        SCOPED_TRACE("ocean " + std::to_string(ocean_number) + ", range " + std::to_string(range) +
                     ", launch " + std::to_string(path.launch_elevation));
        ASSERT_NE(searched, nullptr);
        EXPECT_NEAR(same->delay, searched->delay, 1e-9);
        EXPECT_NEAR(same->launch_elevation, searched->launch_elevation, 1e-7);
        EXPECT_NEAR(same->arrival_elevation, searched->arrival_elevation, 1e-7);
        EXPECT_EQ(same->caustics, searched->caustics);
        EXPECT_LT(std::abs(same->amplitude - searched->amplitude),
                  1e-5 * std::abs(searched->amplitude));
        EXPECT_EQ(same->bounces.size(), searched->bounces.size());
      }
    }
  }
  EXPECT_GT(all, 2000);
  EXPECT_GT(followed, 0.8 * all);
  EXPECT_GT(near_followed, 0.9 * near_all);
}

// A path that ends is not followed to something else: a direct path into the shadow of a surface
// duct's lower edge, a bounce that becomes a turn.
TEST(FollowedPath, LosesWhatIsNoMore) {
  Environment ocean{.water = SoundSpeedProfile::table(std::vector{0.0, 4000.0},
                                                      std::vector{1540.0, 1480.0},
                                                      Interpolation::n2_linear)};
  ocean.bottom = {.depth = 4000.0, .material = Rigid{}};
  const EigenraySolver solver(ocean);
  const PathLimits limits{.max_surface_bounces = 0, .max_bottom_bounces = 0};
  double range = 1000.0;
  Arrivals paths = solver.find(50.0, 50.0, range, 1000.0, limits);
  ASSERT_FALSE(paths.empty());
  Arrival path = paths.front();
  // The downward refracting water bends every ray away from a receiver far enough off.
  int steps = 0;
  for (; steps < 10000; ++steps) {
    range += 10.0;
    const auto next = solver.follow(path, 50.0, 50.0, range, 1000.0, limits);
    if (!next) break;
    path = *next;
    const Arrivals searched = solver.find(50.0, 50.0, range, 1000.0, limits);
    const Arrival* same = nearest(searched, path);
    ASSERT_NE(same, nullptr) << range;
    EXPECT_NEAR(path.delay, same->delay, 1e-9);
  }
  EXPECT_LT(steps, 10000);
}

}  // namespace
}  // namespace asdic::detail
