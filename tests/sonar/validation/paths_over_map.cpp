#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "raytrace/places/propagation_paths.h"
#include "support/map_of.h"

namespace asdic::detail {
namespace {

/// 60 m of water over a floor whose hills of 1 m in 400 m part paths wherever one looks.
PropagationPaths rough_shelf() {
  Environment ocean;
  ocean.water = SoundSpeedProfile::table(std::vector{0.0, 20.0, 30.0, 80.0},
                                         std::vector{1510.0, 1509.0, 1490.0, 1491.0},
                                         Interpolation::c_linear);
  ocean.bottom = {.depth = 60.0, .material = FluidHalfSpace{}};
  auto area = std::make_shared<const Area>(
      Area::Maps{.floor = support::floor_of(10e3, 100.0,
                                            [](double x, double y) {
                                              return 60.0 +
                                                     std::sin(x / 60.0) * std::sin(y / 70.0 + 0.3);
                                            })},
      ocean);
  return {ocean, {}, std::move(area)};
}

double energy_of(const Arrivals& paths) {
  double sum = 0.0;
  for (const Arrival& path : paths) sum += std::norm(path.amplitude);
  return sum;
}

// Ends move by metres. Every path that is heard is followed to one that a search for all finds
// there. What is lost are rays that part within millimetres, q = 10⁶ m and more: hardly any sound.
TEST(PathsOverMap, FollowedPathsAreThoseOfASearch) {
  const PropagationPaths paths = rough_shelf();
  const PathLimits limits{.max_surface_bounces = 3, .max_bottom_bounces = 3};
  const Vec3 from(100.0, 200.0, 25.0), to(1900.0, 2300.0, 40.0);
  const Arrivals known = paths.find(from, to, 1000.0, limits);
  ASSERT_GT(known.size(), 200U);
  const double whole = energy_of(known);
  const auto same = [](const Arrival& a, const Arrival& b) {
    return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
           std::abs(a.delay - b.delay) < 3e-8 &&  // 0.1 mm of depth by sin θ/c
           std::abs(a.launch_elevation - b.launch_elevation) < 1e-5 &&
           std::abs(std::abs(a.amplitude) / std::abs(b.amplitude) - 1.0) < 0.01;
  };
  for (const double moved : {0.001, 0.2, 1.0, 3.0}) {
    const Vec3 there = to + moved * Vec3(0.8, -0.6, 0.05);
    const Arrivals all = paths.find(from, there, 1000.0, limits);
    double lost = 0.0;
    std::size_t heard = 0;
    for (const Arrival& path : known) {
      const Arrivals found = paths.follow(std::span(&path, 1), from, there, 1000.0, limits);
      ASSERT_LE(found.size(), 1U);
      if (found.empty()) {
        lost += std::norm(path.amplitude);
        continue;
      }
      if (std::norm(path.amplitude) < 4e-3 * whole) continue;
      ++heard;
      EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                              [&](const Arrival& other) { return same(other, found.front()); }))
          << moved << ' ' << path.launch_elevation;
    }
    EXPECT_LT(lost, 0.005 * whole) << moved;
    EXPECT_GT(heard, 20U);
    EXPECT_LE(paths.follow(known, from, there, 1000.0, limits).size(), known.size());
  }
}

}  // namespace
}  // namespace asdic::detail
