// Paths to a cell that are received as one, and bundles of very many of them.
#include "reverb/pairs/path_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {
namespace {

constexpr double frequency = 1000.0, c = 1500.0;

/// 100 m of water over sand, a source at 30 m, forty bounces.
FanPlane plane() {
  Environment sea;
  sea.water = SoundSpeedProfile::isovelocity(c);
  sea.bottom = {.depth = 100.0,
                .material = FluidHalfSpace{
                    .speed = 1700.0, .density = 2000.0, .attenuation_db_per_wavelength = 0.5}};
  const EigenraySolver solver(sea);
  PathLimits limits;
  limits.max_surface_bounces = limits.max_bottom_bounces = 40;
  FanPlane found{.paths = std::make_shared<BoundaryPaths>(boundary_paths(
                     solver, 30.0, BoundaryKind::bottom, 40.0, 10e3, frequency, limits)),
                 .ends = {},
                 .facets = {}};
  for (const BoundaryPath& p : found.paths->all())
    found.ends.push_back({.launch_level = std::cos(p.launch_elevation) / c,
                          .launch_down = -std::sin(p.launch_elevation) / c,
                          .sine = std::sin(p.grazing),
                          .cosine = std::cos(p.grazing),
                          .down = p.downward * std::sin(p.grazing) / c});
  return found;
}

TEST(PathGroups, EveryPathIsInOneGroup) {
  const FanPlane fan = plane();
  for (const PathResolution& alike :
       {PathResolution{}, PathResolution{.delay = 0.005, .level = 5.0, .depth = 1.0}}) {
    const GroupedPaths grouped(fan, alike, frequency);
    for (std::size_t cell = 0; cell < fan.paths->cells(); ++cell) {
      std::vector<int> met(fan.paths->paths(cell).size(), 0);
      for (const PathGroup& group : grouped.groups(cell)) {
        EXPECT_TRUE(alike.delay > 0.0 || group.count == 1);
        for (const std::uint32_t i : grouped.members(group)) ++met.at(i);
      }
      for (const int times : met) EXPECT_EQ(times, 1);
    }
  }
}

TEST(PathGroups, NothingInAGroupIsResolved) {
  const FanPlane fan = plane();
  const PathResolution alike{.delay = 0.005, .level = 10.0, .depth = 2.0, .thickness = 1.0};
  const GroupedPaths grouped(fan, alike, frequency);
  EXPECT_TRUE(grouped.added());
  for (std::size_t cell = 0; cell < fan.paths->cells(); ++cell) {
    const std::span<const BoundaryPath> paths = fan.paths->paths(cell);
    const PathEnds* const ends = fan.ends.data() + (paths.data() - fan.paths->all().data());
    for (const PathGroup& group : grouped.groups(cell))
      for (const std::uint32_t i : grouped.members(group)) {
        const std::uint32_t j = group.strongest;
        EXPECT_LE(std::norm(paths[i].amplitude), std::norm(paths[j].amplitude));
        EXPECT_LE(std::abs(paths[i].delay - paths[j].delay), alike.delay);
        const double phase =
            2.0 * pi * frequency *
            (alike.level * std::abs(paths[i].horizontal_slowness - paths[j].horizontal_slowness) +
             alike.depth * std::abs(ends[i].launch_down - ends[j].launch_down) +
             alike.thickness * std::abs(ends[i].down - ends[j].down));
        EXPECT_LE(phase, 0.5 + 1e-9);
      }
  }
}

TEST(PathGroups, BundlesHoldAllGroupsWithTheirShares) {
  const FanPlane fan = plane();
  const GroupedPaths grouped(fan, {}, frequency);
  ASSERT_TRUE(grouped.bundled());
  int bundled = 0;
  for (std::size_t cell = 0; cell < fan.paths->cells(); ++cell) {
    const std::span<const PathGroup> groups = grouped.groups(cell);
    const std::span<const PathBundle> bundles = grouped.bundles(cell);
    EXPECT_EQ(bundles.empty(), groups.size() <= GroupedPaths::bundled_above);
    if (bundles.empty()) continue;
    ++bundled;
    std::size_t next = 0;
    for (const PathBundle& bundle : bundles) {
      EXPECT_EQ(bundle.first, next);
      next += bundle.count;
      double shares = 0.0;
      for (const PathGroup& group : groups.subspan(bundle.first, bundle.count))
        shares += double(group.share);
      EXPECT_NEAR(shares, 1.0, 1e-5);
    }
    EXPECT_EQ(next, groups.size());
  }
  EXPECT_GT(bundled, 200);
}

// Every group is drawn, the weakest too, and has on average the power that it has.
TEST(PathGroups, DrawsOfABundleHaveTheMeanOfEveryGroup) {
  constexpr double shares[] = {0.9, 1e-6, 0.0999, 9.9e-5};
  constexpr int draws = 1'000'000;
  std::vector<PathGroup> groups(1 + std::size(shares));  // the first belongs to another bundle
  for (std::size_t i = 0; i < std::size(shares); ++i)
    groups[i + 1].share = static_cast<float>(shares[i]);
  const PathBundle bundle{.first = 1, .count = std::size(shares)};
  std::vector<double> sum(groups.size());
  for (int n = 0; n < draws; ++n) {
    const DrawnGroup drawn = draw(bundle, groups, (n + 0.5) / draws);
    sum.at(drawn.group) += drawn.gain * drawn.gain / draws;
  }
  EXPECT_EQ(sum[0], 0.0);
  for (std::size_t i = 0; i < std::size(shares); ++i)
    EXPECT_NEAR(sum[i + 1], 1.0, 0.001 + (shares[i] < 1e-3 ? 0.01 : 0.0)) << i;
}

}  // namespace
}  // namespace asdic::detail
