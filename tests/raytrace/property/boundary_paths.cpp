#include "raytrace/paths/boundary_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/units.h"
#include "raytrace/layered/branch_table.h"
#include "raytrace/layered/layer_pass.h"
#include "raytrace/tracing/cell_hits.h"
#include "support/csv.h"
#include "support/test_id.h"

namespace asdic::detail {
namespace {

constexpr double water_depth = 2654.0, spacing = 100.0, max_range = 40e3, frequency = 4000.0;
constexpr PathLimits limits{.max_surface_bounces = 3, .max_bottom_bounces = 1, .faintest = 1e-3};

/// The water of a cast under one rule: next to its smooth maxima and at its kinks rays are as hard
/// to follow as they come.
Environment ocean_of(const std::string& cast, Interpolation rule) {
  const support::Csv csv("casts/" + cast + ".csv");
  Environment ocean;
  ocean.water = SoundSpeedProfile::table(csv["depth"], csv["speed"], rule);
  ocean.bottom = {.depth = water_depth, .material = sediment_of_grain_size(6.0)};
  return ocean;
}

const std::vector<GroundLevel>& levels() {
  static const std::vector<GroundLevel> all = {BoundaryKind::surface, BoundaryKind::bottom,
                                               GroundLevel(300.0)};
  return all;
}

class EveryCastAndRule : public testing::TestWithParam<std::tuple<std::string, Interpolation>> {};
INSTANTIATE_TEST_SUITE_P(
    BoundaryPaths, EveryCastAndRule,
    testing::Combine(testing::Values("autumn0", "autumn4", "spring2", "winter3"),
                     testing::Values(Interpolation::c_linear, Interpolation::n2_linear,
                                     Interpolation::spline, Interpolation::pchip,
                                     Interpolation::pchip_spline_slopes)),
    [](const auto& test) {
      return support::test_id(std::get<0>(test.param) + "_" +
                              std::string(name(std::get<1>(test.param))));
    });

// Each path is finite, and its delay is one that a path to its cell can have: the length is no less
// than the way across, and both go with speeds of this water. The depths are those of ships'
// sonars, and next to samples and to the maximum of the speed, where layers are thin and the water
// is flat.
TEST_P(EveryCastAndRule, PathsFromEveryDepthArePossible) {
  const auto& [cast, rule] = GetParam();
  const Environment ocean = ocean_of(cast, rule);
  const EigenraySolver solver(ocean);
  std::size_t paths = 0;
  for (const double depth :
       {0.0,  1e-6,       1e-3,    3.0,  5.0,       5.00001, 7.0,  8.3,    10.0,  14.999, 18.28,
        20.0, 20.0000003, 34.9999, 35.0, 35.000001, 40.0,    75.0, 99.999, 137.0, 200.0})
    for (const GroundLevel& level : levels()) {
      const BoundaryPaths ground =
          boundary_paths(solver, depth, level, spacing, max_range, frequency, limits);
      for (std::size_t cell = 0; cell < ground.cells(); ++cell)
        for (const BoundaryPath& p : ground.paths(cell)) {
          // the cubics through range and delay are right to a hundredth of the spacing
          ASSERT_GT(p.length, ground.range(cell) - 0.02 * spacing) << depth;
          ASSERT_GT(p.length, 1490.0 * p.delay) << depth;
          ASSERT_LT(p.length, 1560.0 * p.delay) << depth;
          ASSERT_TRUE(std::isfinite(std::abs(p.amplitude))) << depth;
          ++paths;
        }
    }
  EXPECT_GT(paths, 50'000U);
}

/// What arrives at all cells, added as intensities.
double intensity(const BoundaryPaths& ground) {
  double sum = 0.0;
  for (const BoundaryPath& p : ground.all()) sum += std::norm(p.amplitude);
  return sum;
}

/// How many paths are not lost beside the others: most have 1e-4.
double audible(const BoundaryPaths& ground) {
  return double(std::count_if(ground.all().begin(), ground.all().end(),
                              [](const BoundaryPath& p) { return std::abs(p.amplitude) > 1e-6; }));
}

// The layered solver and the marching one, which share no integral, put the same sound on the
// boundaries. They part at caustics and at the edges of what a ray may be (bounces, faintness),
// where cells have one path more or less: a few in ten thousand of the intensity.
TEST_P(EveryCastAndRule, TheMarchingSolverFindsAsMuchSound) {
  const auto& [cast, rule] = GetParam();
  const Environment ocean = ocean_of(cast, rule);
  const EigenraySolver solver(ocean);
  const FanLimits fan{.lowest = -limits.max_launch_angle,
                      .highest = limits.max_launch_angle,
                      .max_surface_bounces = limits.max_surface_bounces,
                      .max_bottom_bounces = limits.max_bottom_bounces,
                      .faintest = limits.faintest};
  for (const GroundLevel& level : levels()) {
    const BoundaryPaths ground =
        boundary_paths(solver, 7.0, level, spacing, max_range, frequency, limits);
    double marched = 0.0;
    for (const CellHit& hit :
         hits_on_cells(*solver.tracer(frequency), 7.0, level, spacing, max_range, frequency, fan))
      marched += std::norm(hit.amplitude);
    EXPECT_NEAR(db_from_power(intensity(ground) / marched), 0.0, 0.05);
  }
}

// Cells that are wide further out hold the paths that narrow ones hold at their centres, and near
// by they are narrow: the same delays (to a hundredth of the spacing each), the same sound. Cells
// that fall on the border of a family of rays have one path more or less.
TEST_P(EveryCastAndRule, WideCellsHoldThePathsOfNarrowOnes) {
  const auto& [cast, rule] = GetParam();
  const Environment ocean = ocean_of(cast, rule);
  const EigenraySolver solver(ocean);
  constexpr double narrow = 20.0, near = 2000.0;
  constexpr std::size_t times = 5;  // as wide: every fifth centre is one of both
  for (const GroundLevel& level : levels()) {
    const auto on = [&](const GroundGrid& grid) {
      return boundary_paths(solver, 7.0, level, grid, max_range, frequency, limits);
    };
    const BoundaryPaths all = on(narrow), wide = on({narrow, times * narrow, near});
    const std::size_t border = std::size_t(near / narrow);
    ASSERT_EQ(wide.cells(), border + (all.cells() - border) / times);
    double sum = 0.0, of_wide = 0.0;
    std::size_t same = 0;
    for (std::size_t cell = 0; cell < wide.cells(); ++cell) {
      const std::size_t match = cell < border ? cell : border + (cell - border) * times + times / 2;
      ASSERT_NEAR(wide.range(cell), all.range(match), 1e-9);
      ASSERT_EQ(std::size_t(wide.grid().at(wide.range(cell))), cell);
      const auto paths = wide.paths(cell), matches = all.paths(match);
      for (const BoundaryPath& p : paths) of_wide += std::norm(p.amplitude);
      for (const BoundaryPath& p : matches) sum += std::norm(p.amplitude);
      if (paths.size() != matches.size()) continue;
      bool alike = true;
      for (std::size_t i = 0; i < paths.size(); ++i)
        alike = alike && std::abs(paths[i].delay - matches[i].delay) < 0.02 * narrow / 1500.0;
      same += alike ? 1 : 0;
    }
    EXPECT_GT(double(same), 0.995 * double(wide.cells()));
    EXPECT_NEAR(db_from_power(of_wide / sum), 0.0, 0.02);
  }
}

// A source a millimetre deeper receives the same: before the differences of speeds next to the
// maximum were exact, a depth had up to ten times the paths of its neighbour.
TEST_P(EveryCastAndRule, AMillimetreChangesLittle) {
  const auto& [cast, rule] = GetParam();
  const Environment ocean = ocean_of(cast, rule);
  const EigenraySolver solver(ocean);
  for (const GroundLevel& level : levels()) {
    const auto from = [&](double depth) {
      return boundary_paths(solver, depth, level, spacing, max_range, frequency, limits);
    };
    const BoundaryPaths here = from(7.0), beside = from(7.001);
    EXPECT_NEAR(audible(here), audible(beside), 0.02 * audible(here));
    EXPECT_NEAR(db_from_power(intensity(here) / intensity(beside)), 0.0, 0.02);
  }
}

// Ten metres without loss: the energy that falls on the floor is that of the images, 1/R² each,
// also where one cycle in 27 stands for all; cells have paths by the logarithm of their bounces.
TEST(ManyBounces, CyclesStandForThoseAroundThem) {
  constexpr double depth = 10.0, source = 3.0;
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  ocean.bottom = {.depth = depth, .material = Rigid{}};
  constexpr int most = 1700;  // the end of a block: those up to 63·27
  const BoundaryPaths ground = boundary_paths(
      EigenraySolver(ocean), source, BoundaryKind::bottom, 200.0, 4000.0, 1000.0,
      {.max_surface_bounces = most, .max_bottom_bounces = most, .max_vertices = 4000});
  for (std::size_t cell = 0; cell < ground.cells(); ++cell) {
    double images = 0.0, found = 0.0;
    for (int cycle = 0; cycle <= most; ++cycle)
      for (const double down : {depth - source, depth + source}) {
        if (cycle == most && down > depth) continue;  // one more off the surface
        const double height = 2.0 * depth * cycle + down, r = ground.range(cell);
        images += 1.0 / (r * r + height * height);
      }
    for (const BoundaryPath& path : ground.paths(cell)) found += std::norm(path.amplitude);
    EXPECT_NEAR(db_from_power(found / images), 0.0, 0.02) << cell;
    EXPECT_LE(ground.paths(cell).size(), 2U * static_cast<std::size_t>(followed_cycles(most)));
  }
  EXPECT_LT(followed_cycles(most), 200);
}

TEST(ManyBounces, EveryCycleIsToldByOne) {
  int told = 0;
  for (int cycle = 0; cycle < 63 * 81; ++cycle) told += cycles_told_by(cycle);
  EXPECT_EQ(told, 63 * 81);
  for (int cycle = 0; cycle < 63; ++cycle) EXPECT_EQ(cycles_told_by(cycle), 1);
  EXPECT_EQ(cycles_told_by(64), 3);
  EXPECT_EQ(cycles_told_by(65), 0);
}

// Next to a smooth maximum c = c_m − ½κy² a ray that turns short of it, c_turn = c_m(1 − ε),
// lingers: with every factor of four in ε the way in to the turn grows by ln 4·½·√(c_m/κ). Close to
// it speeds differ by less than their rounding, 1.5e-16, does; the cubic's third term is below 1e-4
// of the second there.
TEST(NextToAMaximum, TheRangeGrowsByTheLogarithm) {
  const SoundSpeedProfile water = ocean_of("autumn0", Interpolation::spline).water;
  const std::vector<Layer> layers = make_layers(water, 0.0, water_depth);
  const auto above = std::find_if(layers.begin(), layers.end(), [](const Layer& layer) {
    return layer.c_bottom > layer.c_top && std::abs(layer.at(layer.bottom).dc_dz) < 1e-12;
  });
  ASSERT_NE(above, layers.end());
  const double maximum = above->c_bottom, bend = std::abs(above->at(above->bottom).d2c_dz2);
  const double growth = std::log(4.0) * 0.5 * std::sqrt(maximum / bend);
  // σ is the sine at the layer's top; at σ_end the ray just reaches the maximum.
  const double sigma_end = std::sqrt((maximum - above->c_top) * (maximum + above->c_top)) / maximum;
  const auto way_in = [&](double short_of) {
    const double sigma = sigma_end * (1.0 - short_of);
    return turn(*above, RayParameter(above->c_top, sigma), sigma).range;
  };
  for (double short_of = 1e-4; short_of > 1e-11; short_of /= 4.0)
    EXPECT_NEAR(way_in(short_of / 4.0) - way_in(short_of), growth, 0.02 * growth) << short_of;
}

}  // namespace
}  // namespace asdic::detail
