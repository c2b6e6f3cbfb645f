#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/paths/boundary_paths.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/paths/trace_ray.h"
#include "raytrace/tracing/marching_eigenrays.h"
#include "support/oceans.h"
#include "support/plain_rays.h"
#include "support/test_id.h"

namespace asdic::detail {
namespace {

class EveryOcean : public testing::TestWithParam<support::CurvedOcean> {
 protected:
  static Arrivals find(const RayTracer& tracer, double depth, const ReceiverPoint& receiver,
                       const FanLimits& limits) {
    return marching_eigenrays(tracer, 0.0, depth, std::span(&receiver, 1), limits)[0];
  }
};
INSTANTIATE_TEST_SUITE_P(Marching, EveryOcean, testing::ValuesIn(support::curved_oceans()),
                         [](const auto& test) { return support::test_id(test.param.name); });

/// The arrival of the same history whose delay is nearest.
const Arrival* match(const Arrival& wanted, const Arrivals& among) {
  const Arrival* best = nullptr;
  for (const Arrival& a : among)
    if (a.surface_bounces == wanted.surface_bounces && a.bottom_bounces == wanted.bottom_bounces &&
        (best == nullptr ||
         std::abs(a.delay - wanted.delay) < std::abs(best->delay - wanted.delay)))
      best = &a;
  return best;
}

// Recall: between two neighbours of a dense fan of independently integrated rays that passed the
// same boundaries on either side of a receiver there is an eigenray. And every eigenray's launch
// angle, integrated independently, passes the receiver to 1e-6 of the beam: steps of 4 m are right
// to a micrometre, a ray that touches a line for less than a step is not.
TEST_P(EveryOcean, NoEigenrayIsMissedAndNoneInvented) {
  const support::CurvedOcean& ocean = GetParam();
  const RayTracer tracer(ocean.environment, 1000.0);
  constexpr int most = 4;
  constexpr double widest = 1.1;
  const FanLimits limits{.lowest = -widest,
                         .highest = widest,
                         .max_surface_bounces = most,
                         .max_bottom_bounces = most};
  const std::vector<double> columns = {0.3 * ocean.range, 0.85 * ocean.range};
  const std::vector<double> depths = {6.0, 120.0, 333.0};
  std::vector<ReceiverPoint> receivers;
  for (const double r : columns)
    for (const double z : depths) receivers.push_back({r, z});
  const auto found = marching_eigenrays(tracer, 0.0, ocean.source_depth, receivers, limits);

  const support::PlainRays plain(ocean.environment, 4.0);
  const double end = columns.back() + 50.0;
  int roots = 0, confirmed = 0;
  std::vector<support::PlainRays::Crossing> before;
  double angle_before = 0.0;
  constexpr int rays = 900;
  for (int i = 0; i < rays; ++i) {
    const double angle = -widest + 2.0 * widest * (i + 0.37) / rays;
    auto here = plain.trace(ocean.source_depth, angle, end, 2 * most, columns);
    for (const auto& a : here)
      for (const auto& b : before) {
        if (a.column != b.column || a.history != b.history || a.bounces > most) continue;
        for (std::size_t k = 0; k < depths.size(); ++k) {
          if ((a.depth > depths[k]) == (b.depth > depths[k])) continue;
          ++roots;
          const Arrivals& there = found[a.column * depths.size() + k];
          EXPECT_TRUE(std::any_of(there.begin(), there.end(),
                                  [&](const Arrival& x) {
                                    return x.launch_elevation > angle_before - 1e-5 &&
                                           x.launch_elevation < angle + 1e-5;
                                  }))
              << receivers[a.column * depths.size() + k].range << " m, " << depths[k]
              << " m: none between " << angle_before << " and " << angle;
        }
      }
    before = std::move(here);
    angle_before = angle;
  }
  for (std::size_t i = 0; i < receivers.size(); ++i)
    for (const Arrival& a : found[i]) {
      double miss = 1e300, delay = 1e300;
      for (const auto& c :
           plain.trace(ocean.source_depth, a.launch_elevation, end, 2 * most, columns)) {
        if (columns[c.column] != receivers[i].range ||
            std::abs(c.time - a.delay) > std::abs(delay - a.delay))
          continue;
        miss = std::abs((c.depth - receivers[i].depth) * std::cos(a.arrival_elevation));
        delay = c.time;
      }
      EXPECT_LT(miss, 1e-3 + 1e-6 * std::abs(a.q)) << "launched at " << a.launch_elevation;
      EXPECT_NEAR(delay, a.delay, 2e-6);
      ++confirmed;
    }
  EXPECT_GT(roots, 30);
  EXPECT_GE(confirmed, roots);
}

// Exchanging source and receiver reverses every path, over slopes, swell and fronts too: the same
// delay, bounces and caustics, angles exchanged. The tube's q belongs to the source's angle:
// p(0) = 1/c₀ makes c_s·|q| the reciprocal quantity (the propagator of q and p has determinant 1).
// So a line source's intensity over ρc is reciprocal; a point source's, A² = c_r cos θ_s/(r
// c_s|q|), is so where cos θ/c is the same at both ends, as in a layered ocean: elsewhere the two
// fields turn about different axes. A root is right to 1e-6 m; q varies by 1e-7 of itself over that
// at most here.
TEST_P(EveryOcean, ReciprocityOfPaths) {
  const support::CurvedOcean& ocean = GetParam();
  const RayTracer tracer(ocean.environment, 1000.0);
  const double depth = 180.0, range = 0.7 * ocean.range;
  FanLimits limits{
      .lowest = -1.0, .highest = 1.0, .max_surface_bounces = 3, .max_bottom_bounces = 3};
  const Arrivals there = find(tracer, ocean.source_depth, {range, depth}, limits);
  limits.lowest = pi - 1.5;
  limits.highest = pi + 1.5;
  const ReceiverPoint source{0.0, ocean.source_depth};
  const Arrivals back = marching_eigenrays(tracer, range, depth, std::span(&source, 1), limits)[0];
  const double c_source = sound_speed(ocean.environment, 0.0, ocean.source_depth).c;
  const double c_receiver = sound_speed(ocean.environment, range, depth).c;
  EXPECT_GE(there.size(), 8U);
  for (const Arrival& a : there) {
    const Arrival* b = match(a, back);
    ASSERT_NE(b, nullptr);
    EXPECT_NEAR(a.delay, b->delay, 1e-8);
    EXPECT_NEAR(c_source * std::abs(a.q) / (c_receiver * std::abs(b->q)), 1.0, 1e-6);
    EXPECT_NEAR(std::remainder(b->launch_elevation - a.arrival_elevation - pi, 2.0 * pi), 0.0,
                1e-8);
    EXPECT_NEAR(std::remainder(b->arrival_elevation - a.launch_elevation - pi, 2.0 * pi), 0.0,
                1e-8);
    EXPECT_EQ(a.caustics, b->caustics);
  }
}

TEST_P(EveryOcean, SameBitsForAnyNumberOfThreads) {
  const support::CurvedOcean& ocean = GetParam();
  const RayTracer tracer(ocean.environment, 1000.0);
  const ReceiverPoint receiver{0.5 * ocean.range, 150.0};
  const FanLimits limits{
      .lowest = -0.8, .highest = 0.8, .max_surface_bounces = 2, .max_bottom_bounces = 2};
  const Arrivals many = find(tracer, ocean.source_depth, receiver, limits);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Arrivals single = find(tracer, ocean.source_depth, receiver, limits);
  ASSERT_EQ(many.size(), single.size());
  for (std::size_t i = 0; i < many.size(); ++i) {
    EXPECT_EQ(many[i].delay, single[i].delay);
    EXPECT_EQ(many[i].amplitude, single[i].amplitude);
    EXPECT_EQ(many[i].launch_elevation, single[i].launch_elevation);
  }
}

// A drawn ray with an eigenray's launch angle passes through the receiver after the eigenray's
// length: 1e-3 m is what a launch angle right to 1e-11 leaves.
TEST_P(EveryOcean, EigenraysAreRays) {
  const support::CurvedOcean& ocean = GetParam();
  const EigenraySolver solver(ocean.environment);
  const double range = 0.6 * ocean.range;
  const PathLimits limits{
      .max_surface_bounces = 2, .max_bottom_bounces = 2, .max_launch_angle = 1.0};
  for (const Arrival& a : solver.find(ocean.source_depth, 150.0, range, 1000.0, limits)) {
    const RayPath ray = trace_ray(ocean.environment, ocean.source_depth, a.launch_elevation, range);
    EXPECT_NEAR(ray.points.back().range, range, 1e-9);
    EXPECT_NEAR(ray.points.back().depth, 150.0, 1e-3);
    EXPECT_NEAR(ray.points.back().time, a.delay, 1e-6);
    EXPECT_NEAR(ray.path_length, a.path_length, 1e-3);
    EXPECT_NEAR(ray.final_elevation, a.arrival_elevation, 1e-6);
    EXPECT_EQ(ray.surface_bounces, a.surface_bounces);
    EXPECT_EQ(ray.bottom_bounces, a.bottom_bounces);
  }
}

// Paths gridded on the cells of a boundary are the eigenrays to receivers on it that come from the
// water: to a hundredth of a cell in range and c·delay, the amplitude to 0.2 dB but for those next
// to a caustic, which are held down, and those within centimetres of grazing it, which are fainter
// than −80 dB.
TEST_P(EveryOcean, BoundaryPathsAreEigenraysToTheBoundary) {
  const support::CurvedOcean& ocean = GetParam();
  const EigenraySolver solver(ocean.environment);
  const PathLimits limits{
      .max_surface_bounces = 1, .max_bottom_bounces = 1, .max_launch_angle = 1.3};
  for (const auto kind : {BoundaryKind::surface, BoundaryKind::bottom}) {
    const Boundary& wall =
        kind == BoundaryKind::surface ? ocean.environment.surface : ocean.environment.bottom;
    const BoundaryPaths ground =
        boundary_paths(solver, ocean.source_depth, kind, 25.0, ocean.range, 1000.0, limits);
    std::size_t compared = 0, matched = 0;
    for (std::size_t cell = 20; cell < ground.cells(); cell += 61) {
      const double range = ground.range(cell);
      Arrivals exact = solver.find(ocean.source_depth, wall.depth_at(range), range, 1000.0, limits);
      const double slope = wall.shape ? std::atan(wall.shape->at(range).slope) : 0.0;
      std::erase_if(exact, [&](const Arrival& a) {  // t·(downward normal) = −sin(elevation + slope)
        const double down = -std::sin(a.arrival_elevation + slope);
        return (kind == BoundaryKind::bottom ? down : -down) < 1e-9;
      });
      std::size_t gridded = 0;
      for (const BoundaryPath& p : ground.paths(cell)) {
        if (std::abs(p.amplitude) < 1e-4 / range) continue;
        ++gridded;
        const auto near =
            std::min_element(exact.begin(), exact.end(), [&](const Arrival& a, const Arrival& b) {
              return std::abs(a.launch_elevation - p.launch_elevation) <
                     std::abs(b.launch_elevation - p.launch_elevation);
            });
        ASSERT_NE(near, exact.end());
        ++compared;
        EXPECT_NEAR(p.delay, near->delay, 0.3 / 1500.0);
        // at a caustic the launch angle, and with it the grazing angle, is open
        if (std::abs(db_from_amplitude(std::abs(p.amplitude / near->amplitude))) > 0.2) continue;
        EXPECT_NEAR(p.grazing, std::abs(near->arrival_elevation + slope), radians(0.1));
        matched += std::abs(std::arg(p.amplitude / near->amplitude)) < 0.05;
      }
      EXPECT_EQ(gridded, exact.size()) << "range " << range;
    }
    EXPECT_GT(compared, 4U);
    EXPECT_GE(double(matched), 0.75 * double(compared)) << compared;
  }
}

// A wall of rock that rises at 45° in uniform water: the first reflection is that of a plane
// mirror. The image of the source (0, z) in the line d = D − (r − R) has swapped coordinates, and
// rays that came level go straight up; those launched downward come back to smaller ranges.
TEST(MarchingEigenrays, TurnBackAtASlope) {
  Environment ocean{.water = SoundSpeedProfile::isovelocity(1500.0)};
  ocean.bottom = {.depth = 1000.0, .material = Rigid{}};
  ocean.bottom.shape = BoundaryShape(std::vector{3000.0, 3950.0}, std::vector{1000.0, 50.0},
                                     ShapeInterpolation::piecewise_linear);
  const RayTracer tracer(ocean, 1000.0);
  const double source = 500.0;
  const ReceiverPoint receiver{3250.0, 300.0};
  const Arrivals found = marching_eigenrays(
      tracer, 0.0, source, std::span(&receiver, 1),
      {.lowest = -1.2, .highest = 1.2, .max_surface_bounces = 0, .max_bottom_bounces = 1})[0];
  // The mirror line: r + z = 4000. (r, z) ↦ (4000 − z, 4000 − r).
  const double image_r = 4000.0 - source, image_z = 4000.0;
  const double way = std::hypot(receiver.range - image_r, receiver.depth - image_z);
  const auto mirrored = std::find_if(found.begin(), found.end(), [&](const Arrival& a) {
    return a.bottom_bounces == 1 && std::abs(a.arrival_elevation) > 0.5 * pi;
  });
  ASSERT_NE(mirrored, found.end());
  EXPECT_NEAR(mirrored->delay, way / 1500.0, 1e-10);
  EXPECT_NEAR(std::abs(mirrored->q), way, 1e-6 * way);
  EXPECT_NEAR(mirrored->arrival_elevation,
              std::atan2(image_z - receiver.depth, receiver.range - image_r), 1e-9);
  EXPECT_NEAR(mirrored->spreading, 1.0 / way, 1e-10);
}

// Source and receiver on a knot of the profile, on a grid line, on a boundary and on one of its
// nodes: the limit of places beside them.
TEST(MarchingEigenrays, PlacesOnKnotsNodesAndBoundaries) {
  for (const support::CurvedOcean& ocean : support::curved_oceans()) {
    if (ocean.name != "front over a ridge" && ocean.name != "faceted ridge") continue;
    const EigenraySolver solver(ocean.environment);
    const PathLimits limits{
        .max_surface_bounces = 1, .max_bottom_bounces = 1, .max_launch_angle = 1.0};
    struct Place {
      double source, range, depth, down;
    };
    const double node = ocean.environment.bottom.shape->ranges()[20];
    for (const Place& p : {Place{60.0, 2500.0, 150.0, 1.0}, Place{300.0, 5000.0, 60.0, 1.0},
                           Place{150.0, 4000.0, 0.0, 1.0},
                           Place{150.0, node, ocean.environment.bottom.depth_at(node), -1.0}}) {
      const Arrivals on = solver.find(p.source, p.depth, p.range, 1000.0, limits);
      const Arrivals by =
          solver.find(p.source + 1e-3, p.depth + p.down * 1e-3, p.range, 1000.0, limits);
      EXPECT_GE(on.size(), 3U);
      for (const Arrival& a : by) {
        // reflected at the node itself: into which direction is anyone's guess
        if (!a.bounces.empty() && std::abs(a.bounces.back().range - p.range) < 0.1) continue;
        const Arrival* b = match(a, on);
        ASSERT_NE(b, nullptr) << ocean.name << " launched at " << a.launch_elevation;
        EXPECT_NEAR(a.delay, b->delay, 2e-6) << ocean.name;  // 2 mm of way
      }
    }
  }
}

}  // namespace
}  // namespace asdic::detail
