#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "raytrace/tracing/marching_eigenrays.h"
#include "support/deep.h"
#include "support/oceans.h"
#include "support/test_id.h"

namespace asdic::detail {
namespace {

const support::CurvedOcean& ocean_of(const std::vector<support::CurvedOcean>& all,
                                     const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const auto& o) { return o.name == name; });
}

bool has_match(const Arrival& wanted, const Arrivals& among) {
  // roots are right to 1e-6 m, which is 1e-6/|q| of launch angle, and families' to ten times that
  return std::any_of(among.begin(), among.end(), [&](const Arrival& a) {
    return a.surface_bounces == wanted.surface_bounces &&
           a.bottom_bounces == wanted.bottom_bounces &&
           std::abs(a.launch_elevation - wanted.launch_elevation) <
               1e-9 + 1e-4 / (1.0 + std::abs(wanted.q)) &&
           std::abs(a.delay - wanted.delay) < 1e-7;
  });
}

// What a search for one receiver leaves out of the fan is what no ray to it needs. A search for
// forty receivers at once splits the fan for each of them, some forty times finer: it knows no path
// to one of them that the search for it alone does not find, nor the other way round. Receivers lie
// anywhere, more of them near the surface. A gap: rays that graze the crests of a swell strike one
// or the next of them, and families between, 1e-5 rad wide and spread to a fifth of spherical
// amplitude and less, may lie between two rays of a fan that see nothing of them.
class OneOfMany : public testing::TestWithParam<support::CurvedOcean> {};
INSTANTIATE_TEST_SUITE_P(Marching, OneOfMany, testing::ValuesIn(support::curved_oceans()),
                         [](const auto& test) { return support::test_id(test.param.name); });

TEST_P(OneOfMany, IsServedAsWellAlone) {
  const support::CurvedOcean& ocean = GetParam();
  const RayTracer tracer(ocean.environment, 500.0);
  std::mt19937 generator(100);
  std::uniform_real_distribution<> uniform(0.0, 1.0);
  std::vector<ReceiverPoint> receivers;
  for (int i = 0; i < 40; ++i) {
    const double r = ocean.range * (0.02 + 1.08 * uniform(generator));
    const double deepest = ocean.environment.bottom.depth_at(r) - 1.0;
    receivers.push_back({r, 3.0 + (deepest - 3.0) * std::pow(uniform(generator), 1.5)});
  }
  const FanLimits limits{
      .lowest = -1.2, .highest = 1.2, .max_surface_bounces = 6, .max_bottom_bounces = 6};
  const auto together = marching_eigenrays(tracer, 0.0, ocean.source_depth, receivers, limits);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const Arrivals alone =
        marching_eigenrays(tracer, 0.0, ocean.source_depth, std::span(&receivers[i], 1), limits)[0];
    const bool swell = ocean.name == "swell";
    for (const Arrival& a : together[i])
      EXPECT_TRUE((swell && a.spreading * receivers[i].range < 0.2) || has_match(a, alone))
          << receivers[i].range << ", " << receivers[i].depth << " at " << a.launch_elevation;
    for (const Arrival& a : alone)
      EXPECT_TRUE(has_match(a, together[i]))
          << receivers[i].range << ", " << receivers[i].depth << " at " << a.launch_elevation;
    compared += alone.size();
  }
  EXPECT_GT(compared, 400U);
}

// Up the flank of a ridge rays are turned upright and sent back. A leg is then a few metres wide,
// and between two neighbours of a fan it passes from one side of a receiver to the other without
// either of them meeting the receiver's range: the four paths are there (launch angles by a fan of
// 4096 first intervals, each of them a ray that EigenraysAreRays would accept).
TEST(MarchingRecall, UprightLegsSweepOverReceivers) {
  const auto all = support::curved_oceans();
  const support::CurvedOcean& ocean = ocean_of(all, "smooth ridge");
  const RayTracer tracer(ocean.environment, 500.0);
  const ReceiverPoint receiver{4000.0, 100.0};
  const Arrivals found = marching_eigenrays(
      tracer, 0.0, ocean.source_depth, std::span(&receiver, 1),
      {.lowest = -1.2, .highest = 1.2, .max_surface_bounces = 6, .max_bottom_bounces = 6})[0];
  for (const double launch : {-0.59143184, -0.59248799, 0.59202977, 0.59243624})
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const Arrival& a) {
      return std::abs(a.launch_elevation - launch) < 1e-7;
    })) << launch;
}

/// An ocean whose water and whose floor of a few nodes are drawn at random.
struct DrawnFloor {
  Environment ocean;
  double source = 0.0;
  ReceiverPoint receiver;
};
DrawnFloor drawn_floor(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(generator);
  };
  DrawnFloor drawn;
  const double deep = std::pow(10.0, draw(1.7, 3.3)), range = deep * draw(3.0, 40.0);
  const int nodes = 3 + static_cast<int>(draw(0.0, 8.0));
  const double relief = draw(0.02, 0.6);
  std::vector<double> ranges = {-0.5 * range}, depths;
  for (int i = 0; i < nodes; ++i) ranges.push_back(range * (i + draw(0.1, 0.9)) / nodes);
  ranges.push_back(1.5 * range);
  for (std::size_t i = 0; i < ranges.size(); ++i)
    depths.push_back(deep * (1.0 - relief * draw(0.0, 1.0)));
  constexpr ShapeInterpolation rules[] = {ShapeInterpolation::piecewise_linear,
                                          ShapeInterpolation::smooth,
                                          ShapeInterpolation::curvilinear};
  Environment& ocean = drawn.ocean;
  ocean.bottom = {.depth = deep, .material = FluidHalfSpace{}};
  ocean.bottom.shape = BoundaryShape(ranges, depths, rules[static_cast<int>(draw(0.0, 3.0))]);
  const int water = static_cast<int>(draw(0.0, 3.0));
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  if (water > 0) {
    const std::vector<double> at = {0.0, 0.1 * deep, 0.3 * deep, deep};
    std::vector<double> speed = {1515.0, 1512.0, 1495.0, 1500.0};
    for (std::size_t i = 0; i < 4; ++i) speed[i] += draw(-5.0, i == 3 ? 10.0 : 5.0);
    ocean.water = SoundSpeedProfile::table(
        at, speed, water == 1 ? Interpolation::c_linear : Interpolation::pchip);
  }
  drawn.source = draw(0.05, 0.9) * ocean.bottom.shape->depth_at(0.0);
  drawn.receiver = {range, draw(0.05, 0.9) * ocean.bottom.shape->depth_at(range)};
  return drawn;
}

// Energy at a receiver over floors with up to ten nodes. The truth is a search for it and 120
// receivers around it, which splits the fan some hundred times finer. Of 150 draws these lost 0.06
// to 0.67 dB for three reasons. A ray at the largest number of bounces was taken to show that its
// neighbours went no further. A ray that misses the column between two that cross it was taken to
// show that none crosses. Three rays that part far from the receiver were taken to show that none
// between them comes nearer.
TEST(MarchingRecall, ShapesLoseNoPathThatMatters) {
  const std::vector<int> draws = support::deep() ? std::vector<int>{6, 16, 35, 37, 38, 69, 84}
                                                 : std::vector<int>{16, 37, 38, 69};
  for (const int seed : draws) {
    const DrawnFloor drawn = drawn_floor(static_cast<std::uint64_t>(seed));
    const RayTracer tracer(drawn.ocean, 1000.0);
    const FanLimits limits{.lowest = -0.5 * pi,
                           .highest = 0.5 * pi,
                           .max_surface_bounces = 3,
                           .max_bottom_bounces = 3,
                           .faintest = 1e-3};
    std::mt19937_64 generator(77);
    std::uniform_real_distribution<> uniform(0.0, 1.0);
    std::vector<ReceiverPoint> many = {drawn.receiver};
    for (int i = 0; i < 120; ++i) {
      const double range =
          drawn.receiver.range * (i % 2 == 0 ? 1.0 : 0.9 + 0.2 * uniform(generator));
      many.push_back(
          {range, (0.02 + 0.96 * uniform(generator)) * drawn.ocean.bottom.shape->depth_at(range)});
    }
    const auto energy = [](const Arrivals& paths) {
      double sum = 0.0;
      for (const Arrival& path : paths) sum += std::norm(path.amplitude);
      return sum;
    };
    const double alone = energy(
        marching_eigenrays(tracer, 0.0, drawn.source, std::span(&drawn.receiver, 1), limits)[0]);
    const double truth = energy(marching_eigenrays(tracer, 0.0, drawn.source, many, limits)[0]);
    EXPECT_NEAR(10.0 * std::log10(alone / truth), 0.0, 0.05) << seed;
  }
}

// A receiver just above a rising bottom: the leg that begins on the bottom before it does so deeper
// than where the neighbour's leg begins behind it.
TEST(MarchingRecall, ReceiversCloseOverASlope) {
  const auto all = support::curved_oceans();
  const support::CurvedOcean& ocean = ocean_of(all, "wedge");
  const RayTracer tracer(ocean.environment, 500.0);
  const double range = 7440.0, bottom = ocean.environment.bottom.depth_at(range);
  const FanLimits limits{
      .lowest = -1.2, .highest = 1.2, .max_surface_bounces = 6, .max_bottom_bounces = 6};
  // the paths to a receiver on the bottom come in pairs, before and after the reflection, to one
  // above it: as many of them at 0.1 m as at 8 m
  std::size_t paths = 0;
  for (const double above : {0.1, 1.0, 8.0}) {
    const ReceiverPoint receiver{range, bottom - above};
    const Arrivals found =
        marching_eigenrays(tracer, 0.0, ocean.source_depth, std::span(&receiver, 1), limits)[0];
    if (paths == 0) paths = found.size();
    EXPECT_EQ(found.size(), paths) << above;
  }
  EXPECT_GT(paths, 15U);
}

}  // namespace
}  // namespace asdic::detail
