#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "raytrace/layered/root_search.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/tracing/marching_eigenrays.h"
#include "support/deep_ocean.h"
#include "support/oceans.h"
#include "support/test_id.h"

// What a search costs grows with what it finds: counted in rays, segments, pieces and roots,
// which are the same on every machine.
namespace asdic::detail {
namespace {

std::size_t paths_of(const std::vector<Arrivals>& found) {
  return std::accumulate(found.begin(), found.end(), std::size_t{0},
                         [](std::size_t n, const Arrivals& here) { return n + here.size(); });
}

struct Search {
  std::size_t paths;
  SearchCost cost;
};

Search march(const support::CurvedOcean& ocean, const std::vector<ReceiverPoint>& receivers,
             double widest = 1.2) {
  const RayTracer tracer(ocean.environment, 500.0);
  SearchWatch watch;
  const auto found = marching_eigenrays(
      tracer, 0.0, ocean.source_depth, receivers,
      {.lowest = -widest, .highest = widest, .max_surface_bounces = 4, .max_bottom_bounces = 4},
      &watch);
  return {paths_of(found), watch.cost};
}

/// So many receivers down a column, away from the bottom.
std::vector<ReceiverPoint> column(double range, std::size_t n) {
  std::vector<ReceiverPoint> receivers;
  for (std::size_t i = 0; i < n; ++i)
    receivers.push_back({range, 20.0 + 330.0 * (double(i) + 0.5) / double(n)});
  return receivers;
}

class SearchCostOf : public testing::TestWithParam<support::CurvedOcean> {};
INSTANTIATE_TEST_SUITE_P(Marching, SearchCostOf, testing::ValuesIn(support::curved_oceans()),
                         [](const auto& test) { return support::test_id(test.param.name); });

// One fan serves all: a ray is traced for the fan, or for a root, of which each takes two or three
// and, under swell, has the fan split around it, or as one of five for a family of roots (next to
// their ends, where families are narrow, about one for each root); never for a receiver.
TEST_P(SearchCostOf, IsAFanAndSomeRaysAPath) {
  const support::CurvedOcean& ocean = GetParam();
  const double range = 0.8 * ocean.range;
  const Search one = march(ocean, column(range, 1)), few = march(ocean, column(range, 10)),
               many = march(ocean, column(range, 1000));
  EXPECT_GT(few.paths, 60U);
  EXPECT_LE(few.cost.rays, one.cost.rays + 4 * few.paths);
  EXPECT_GT(many.paths, 50 * few.paths);
  EXPECT_LE(many.cost.rays, one.cost.rays + 3 * many.paths / 2);
  // rays to a column are no longer for more receivers in it
  EXPECT_LE(many.cost.segments * one.cost.rays, 3 * one.cost.segments * many.cost.rays / 2);
}

// A thousand receivers that no ray passes cost nothing: rays within 0.1 rad are far above them.
TEST_P(SearchCostOf, IsNoneForReceiversThatNoRayPasses) {
  const support::CurvedOcean& ocean = GetParam();
  const double range = 0.2 * ocean.range;
  std::vector<ReceiverPoint> receivers = {{range, 60.0}};
  const Search few = march(ocean, receivers, 0.1);
  for (int i = 0; i < 1000; ++i) receivers.push_back({range, 500.0 + 0.2 * i});
  const Search many = march(ocean, receivers, 0.1);
  EXPECT_GT(few.paths, 0U);
  EXPECT_EQ(many.paths, few.paths);
  EXPECT_EQ(many.cost.rays, few.cost.rays);
}

/// What EigenraySolver asks of a layered ocean's fan: monotone pieces that may hold receivers,
/// a task for each receiver on one, lanes full of tasks.
struct LayeredSearch {
  std::size_t pieces = 0, tasks = 0, batches = 0;
};
LayeredSearch search(const EigenraySolver& solver, const std::vector<double>& ranges,
                     const PathLimits& limits) {
  const auto shared = solver.table(4500.0, 125.0, limits);
  const BranchTable& fan = *shared;
  LayeredSearch cost;
  fan.for_each_piece(ranges, [&](const MonotonePiece& piece) {
    ++cost.pieces;
    const RootPiece held(piece, fan.column().source_is_upper());
    const auto [low, high] = std::minmax(piece.range_begin, piece.range_end);
    std::vector<RootTask> tasks;
    for (auto r = std::ranges::lower_bound(ranges, low); r != ranges.end() && *r <= high; ++r)
      tasks.push_back({.piece = &held, .receiver = 0, .range = *r});
    cost.tasks += tasks.size();
    if (!tasks.empty())
      RootGroups(fan, *piece.interval, tasks).solve([&](const SimdTasks&, const FoundRays&) {
        ++cost.batches;
      });
  });
  return cost;
}

// A layered ocean: the fan is the same for any number of receivers, pieces are those of the fan,
// and beyond them there is one root for each path (but one twice, on the end that two pieces
// share), some at a time.
TEST(SearchCostLayered, IsAFanAndARootAPath) {
  const PathLimits limits{
      .max_surface_bounces = 3, .max_bottom_bounces = 3, .max_launch_angle = 1.4};
  for (const char* law : {"c-linear", "n2-linear", "pchip", "spline", "munk"}) {
    const EigenraySolver solver(support::deep_ocean(law));
    std::size_t pieces_of_few = 0;
    for (const std::size_t n : {10U, 100U, 1000U, 10000U}) {
      std::vector<double> ranges;
      for (std::size_t i = 0; i < n; ++i)
        ranges.push_back(1000.0 + 50e3 * double(i) / double(n - 1));
      const LayeredSearch cost = search(solver, ranges, limits);
      if (n == 10) pieces_of_few = cost.pieces;
      // extrema near receivers are found and cut a piece in two
      EXPECT_LE(cost.pieces, 2 * pieces_of_few) << law;
      const std::size_t paths = paths_of(solver.find(4500.0, 125.0, ranges, 4000.0, limits));
      EXPECT_GE(cost.tasks, paths) << law;
      EXPECT_LE(cost.tasks, paths + cost.pieces) << law;
      EXPECT_LE(cost.batches, cost.tasks / rays_at_once + 2 * cost.pieces) << law;
    }
    // farther than paths of twelve turning points and bounces go there is nothing to look at
    std::vector<double> beyond;
    for (int i = 0; i < 1000; ++i) beyond.push_back(2000e3 + 10.0 * i);
    const LayeredSearch none = search(
        solver, beyond, {.max_surface_bounces = 3, .max_bottom_bounces = 3, .max_vertices = 12});
    EXPECT_EQ(none.tasks, 0U) << law;
    EXPECT_EQ(none.batches, 0U) << law;
  }
}

}  // namespace
}  // namespace asdic::detail
