#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "raytrace/layered/branch_table.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/tracing/marching_eigenrays.h"
#include "raytrace/tracing/ray_tracer.h"
#include "support/deep_ocean.h"
#include "support/oceans.h"
#include "support/test_id.h"

// None missed: the search against 200 000 rays, every two neighbours of one history that pass the
// receiver on either side of it. (The rays' own correctness: raytrace_layered_search.cpp,
// raytrace_tracer.cpp, against independent integrators.)
namespace asdic::detail {
namespace {

constexpr int rays = 200'000;
constexpr double widest = 1.3;  // launch angles [rad]

double launch_angle(int i) { return widest * (i + 0.5) / rays; }  // of layered oceans: upper half

struct LayeredCase {
  const char* name;
  Environment ocean;
  double source, receiver;
  int bounces;
};

std::vector<LayeredCase> layered_cases() {
  Environment pekeris{.water = SoundSpeedProfile::isovelocity(1500.0)};
  pekeris.bottom = {.depth = 200.0, .material = FluidHalfSpace{.speed = 1700.0}};
  return {{"Munk's law, deep source", support::deep_ocean("munk"), 4500.0, 125.0, 6},
          {"Munk's law in the channel", support::deep_ocean("munk"), 1000.0, 800.0, 6},
          {"Pekeris", pekeris, 36.0, 150.0, 40},
          {"spline in the channel", support::deep_ocean("spline"), 1000.0, 700.0, 6},
          {"samples joined by lines", support::deep_ocean("c-linear"), 1250.0, 800.0, 6}};
}

class RecallSlow : public testing::TestWithParam<LayeredCase> {};
INSTANTIATE_TEST_SUITE_P(Search, RecallSlow, testing::ValuesIn(layered_cases()),
                         [](const auto& test) { return support::test_id(test.param.name); });

TEST_P(RecallSlow, TwoHundredThousandRaysFindNoMoreInALayeredOcean) {
  const auto& [name, ocean, source, receiver, bounces] = GetParam();
  const EigenraySolver solver(ocean);
  const PathLimits limits{
      .max_surface_bounces = bounces, .max_bottom_bounces = bounces, .max_launch_angle = widest};
  const auto kept = solver.table(source, receiver, limits);
  const BranchTable& table = *kept;
  const Column& column = table.column();
  std::vector<ColumnSums> fan;
  std::vector<double> angle;
  for (int i = 0; i < rays; ++i) {
    const RayParameter ray(column.source_speed(), std::sin(launch_angle(i)));
    if (!(ray.sine2(column.barrier_speed()) > 0.0)) continue;
    fan.push_back(column.sums(ray));
    angle.push_back(launch_angle(i));
  }
  const std::vector<double> ranges = {1e3, 2.7e3, 7e3, 14e3, 23e3, 30e3, 37e3, 49e3, 60e3};
  const auto found = solver.find(source, receiver, ranges, 1000.0, limits);
  std::size_t roots = 0;
  for (const bool up : {true, false})
    for (int k = 0; k <= 2 * bounces + 40; ++k) {
      const Branch branch{.starts_up = up, .vertices = k};
      if (k == 0 && up == column.source_is_upper()) continue;
      const BranchWeights w = weights(branch, column.source_is_upper());
      for (std::size_t i = 0; i + 1 < fan.size(); ++i) {
        const ColumnSums &a = fan[i], &b = fan[i + 1];
        if (a.turns_above != b.turns_above || a.turns_below != b.turns_below) continue;
        if (!a.turns_above && branch.top_vertices() > bounces) continue;
        if (!a.turns_below && branch.bottom_vertices() > bounces) continue;
        const double r_a = w.of(a.up.range, a.middle.range, a.down.range),
                     r_b = w.of(b.up.range, b.middle.range, b.down.range);
        const auto [low, high] = std::minmax(r_a, r_b);
        if (!std::isfinite(low + high)) continue;
        // A jump of r, past a maximum of c, is no root: neighbours of a continuous piece differ
        // by their slopes.
        if (high - low > 50.0) continue;
        for (std::size_t j = 0; j < ranges.size(); ++j) {
          if (!(low < ranges[j] && ranges[j] <= high)) continue;
          ++roots;
          EXPECT_TRUE(std::any_of(
              found[j].begin(), found[j].end(),
              [&](const Arrival& x) {
                const double there = up ? x.launch_elevation : -x.launch_elevation;
                return there > angle[i] - 1e-9 && there < angle[i + 1] + 1e-9 &&
                       x.surface_bounces + x.bottom_bounces + x.upper_turns + x.lower_turns == k;
              }))
              << name << ": " << ranges[j] << " m, " << k << " vertices, at " << angle[i];
        }
      }
    }
  EXPECT_GT(roots, 100U);
}

class Depths final : public RangeVisitor {
 public:
  struct Pass {
    std::size_t column;
    double depth;
    int surface, bottom, turns;
  };
  std::vector<Pass> passes;
  void pass(std::size_t column, const RayState& y, const RayHistory& h) override {
    passes.push_back(
        {column, y.depth, h.surface_bounces, h.bottom_bounces, h.upper_turns + h.lower_turns});
  }
};

// A wedge and a ridge under a profile of lines; the fan within ±0.5 rad, for which 200 000 rays are
// 5 µrad apart. Histories are those of boundaries and turning points; facets are no matter of these
// two (a wedge has one, the ridge is smooth).
TEST(RecallSlow, TwoHundredThousandRaysFindNoMoreOverSlopes) {
  for (const support::CurvedOcean& ocean : support::curved_oceans()) {
    if (ocean.name != "wedge" && ocean.name != "smooth ridge") continue;
    const RayTracer tracer(ocean.environment, 1000.0);
    constexpr int most = 8;
    constexpr double steepest = 0.5;
    const std::vector<double> columns = {1000.0, 4000.0, 9000.0};
    const std::vector<double> depths = {30.0, 210.0};
    std::vector<ReceiverPoint> receivers;
    for (const double r : columns)
      for (const double z : depths) receivers.push_back({r, z});
    const auto found = marching_eigenrays(tracer, 0.0, ocean.source_depth, receivers,
                                          {.lowest = -steepest,
                                           .highest = steepest,
                                           .max_surface_bounces = most,
                                           .max_bottom_bounces = most});
    Depths before, here;
    double angle_before = 0.0;
    int roots = 0;
    for (int i = 0; i < rays; ++i) {
      const double angle = -steepest + 2.0 * steepest * (i + 0.5) / rays;
      here.passes.clear();
      tracer.trace_past(columns, 0.0, ocean.source_depth, angle,
                        {.min_range = -1.0,
                         .max_range = 9001.0,
                         .max_surface_bounces = most + 1,
                         .max_bottom_bounces = most + 1},
                        here);
      for (const auto& a : here.passes)
        for (const auto& b : before.passes) {
          if (a.column != b.column || a.surface != b.surface || a.bottom != b.bottom ||
              a.turns != b.turns || a.surface > most || a.bottom > most)
            continue;
          for (std::size_t k = 0; k < depths.size(); ++k) {
            if ((a.depth > depths[k]) == (b.depth > depths[k])) continue;
            if (std::abs(a.depth - b.depth) > 20.0) continue;  // not of one family
            ++roots;
            const Arrivals& there = found[a.column * depths.size() + k];
            EXPECT_TRUE(std::any_of(there.begin(), there.end(),
                                    [&](const Arrival& x) {
                                      return x.launch_elevation > angle_before - 1e-9 &&
                                             x.launch_elevation < angle + 1e-9 &&
                                             x.surface_bounces == a.surface &&
                                             x.bottom_bounces == a.bottom;
                                    }))
                << ocean.name << ": " << columns[a.column] << " m, " << depths[k] << " m, at "
                << angle_before;
          }
        }
      std::swap(before.passes, here.passes);
      angle_before = angle;
    }
    EXPECT_GT(roots, 40);
  }
}

}  // namespace
}  // namespace asdic::detail
