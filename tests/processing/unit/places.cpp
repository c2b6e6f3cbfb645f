#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/doppler.h"
#include "core/geometry.h"
#include "processing/delay_table.h"
#include "processing/localiser.h"
#include "processing/scoring.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/paths/moving_paths.h"

namespace asdic::detail {
namespace {

// Between its nodes a branch is Hermite's cubic through delays and slopes: over 200 m steps of a
// Munk ocean, where delays bend by h⁴/384·τ'''' ≈ 10⁻⁹ s, within a microsecond of the eigenray
// itself away from caustics. Straight lines between nodes would be off by h²/8·τ'' ≈ 10⁻⁵ s.
TEST(DelayTableTest, IsTheEigenraysDelayBetweenItsNodes) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::munk();
  ocean.bottom = {.depth = 5000.0, .material = Rigid{}};
  const EigenraySolver solver(ocean);
  const PathLimits limits{.max_surface_bounces = 1, .max_bottom_bounces = 1};
  std::vector<double> ranges;
  for (int i = 1; i <= 100; ++i) ranges.push_back(200.0 * i);
  const DelayTable table(solver, 4500.0, 125.0, ranges, 4000.0, limits);
  int compared = 0;
  for (const double range : {3050.0, 7777.0, 12510.0, 18130.0})
    for (const Arrival& path : solver.find(4500.0, 125.0, range, 4000.0, limits))
      for (const auto& branch : table.branches()) {
        if (branch.history != history_of(path)) continue;
        const auto node = table.at(branch, range);
        if (!node || std::abs(node->elevation - path.launch_elevation) > 0.01) continue;
        EXPECT_NEAR(node->delay, path.delay, 1e-6) << range;
        EXPECT_NEAR(node->slope, path.horizontal_slowness, 1e-6);
        ++compared;
      }
  EXPECT_GE(compared, 12);
  EXPECT_FALSE(table.at(table.branches().front(), 1e6).has_value());
}

Detection at(double time, double doppler, const Vec3& look, double snr_db = 20.0) {
  return {.time = time, .doppler = doppler, .look = look, .cosine = look.y(), .snr_db = snr_db};
}

// A line to the north receives an echo from the east, and its own transmitter from the north.
TEST(Scoring, TellsHitsMissesAndFalseAlarms) {
  const ArrayShape line{.kind = ArrayKind::line, .axis = Vec3::UnitY(), .length = 10.0};
  const std::vector<TrueEcho> echoes{
      {.target = 0, .time = 10.0, .doppler = 1.002, .level_db = 80.0, .travel = -Vec3::UnitX()},
      {.target = direct_sound,
       .time = 3.0,
       .doppler = std::nan(""),
       .level_db = infinity,
       .travel = -Vec3::UnitY()}};
  const std::vector<TrueTarget> targets{{.target = 0, .present = true, .position = {7500.0, 0, 0}},
                                        {.target = 1, .present = true, .position = {0, 9000.0, 0}}};
  const Resolution cell{.time = 0.1, .doppler = 0.001, .direction = 0.1};
  Detection right = at(10.05, 1.0025, Vec3::UnitX());
  right.locations = {{.position = {7450.0, 30.0, 0.0}, .range = 7450.0, .bearing = 1.5668},
                     {.position = {-7450.0, 30.0, 0.0}, .range = 7450.0, .bearing = -1.5668}};
  const std::vector<Detection> found{
      right,
      at(10.05, 1.0025, -Vec3::UnitX(), 10.0),  // the other side of a line is the same to it
      at(10.2, 1.002, Vec3::UnitX()),           // too late
      at(10.0, 1.004, Vec3::UnitX()),           // another speed
      at(10.0, 1.002, Vec3::UnitY()),           // another direction
      at(3.02, 0.99, Vec3::UnitY())};           // the transmitter itself
  const PingScore score = score_detections(found, echoes, targets, line, Track{}, cell, 1.0, 20.0);
  EXPECT_EQ(score.owner, (std::vector<int>{0, 0, -1, -1, -1, direct_sound}));
  EXPECT_EQ(score.hits, 1);
  EXPECT_EQ(score.misses, 0);  // target 1 has no echo: it is not missed
  EXPECT_EQ(score.false_alarms, 3);
  EXPECT_TRUE(score.targets[0].hit);
  EXPECT_EQ(score.targets[0].detection, 0);  // the louder one
  EXPECT_NEAR(score.targets[0].position_error, std::hypot(50.0, 30.0), 1e-9);
  EXPECT_FALSE(score.targets[1].detectable);
  // Nothing is missed that was not searched for.
  const PingScore nothing = score_detections({}, echoes, targets, line, Track{}, cell, 11.0, 20.0);
  EXPECT_EQ(nothing.misses, 0);
  EXPECT_EQ(score_detections({}, echoes, targets, line, Track{}, cell, 1.0, 20.0).misses, 1);
}

// On a sweep's ridge an error of the Doppler factor moves the time by κ times it.
TEST(Scoring, FollowsASweepsRidge) {
  const ArrayShape point;
  const std::vector<TrueEcho> echoes{{.target = 0, .time = 10.0, .doppler = 1.0}};
  const std::vector<TrueTarget> targets{{.target = 0, .present = true}};
  const Resolution cell{.time = 0.01, .doppler = 0.01, .delay_per_doppler = 40.0, .direction = 2.0};
  const std::vector<Detection> along{at(10.2, 1.005, Vec3::UnitX())},
      across{at(10.2, 0.995, Vec3::UnitX())};
  const auto hits = [&](const std::vector<Detection>& found) {
    return score_detections(found, echoes, targets, point, Track{}, cell, 1.0, 20.0).hits;
  };
  EXPECT_EQ(hits(along), 1);
  EXPECT_EQ(hits(across), 0);
}

// A pair 8 km apart and a target that moves, all at one depth where sound is straight. Half the
// horizontal way changes by ½v·(u_out + u_home); the Doppler factor tells it to the second order,
// (v/c)² of 8/1500: 1 %. By dT/dr, one leg turned by the bistatic angle b, it would be
// 2/(1 + cos b) times as much, twice at 90°.
TEST(LocaliserTest, TellsTheRangeRateOfABistaticPair) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  ocean.bottom = {.depth = 4000.0, .material = Rigid{}};
  const PropagationPaths paths(ocean, {});
  SonarPlaces places;
  places.source.position = {-4000.0, 0.0, 1000.0};
  places.array.start.position = {4000.0, 0.0, 1000.0};
  places.shape = {.kind = ArrayKind::volume, .length = 2.0, .width = 2.0, .height = 2.0};
  const Vec3 velocity(3.0, -7.0, 0.0);
  for (const auto& [x, y] : {std::pair{500.0, 8000.0}, {-2000.0, 4000.0}, {1000.0, 2500.0}}) {
    const Vec3 target(x, y, 1000.0);
    const Separation out = separation(places.source.position, target),
                     home = separation(target, places.array.start.position),
                     seen = separation(places.array.start.position, target);
    const Vec3 in = slowness_vector(out.bearing, 0.0, 1500.0),
               back = slowness_vector(home.bearing, 0.0, 1500.0);
    const Detection received{.time = (out.range + home.range) / 1500.0,
                             .doppler = echo_doppler({Vec3::Zero(), in}, {velocity, in},
                                                     {velocity, back}, {Vec3::Zero(), back}),
                             .look = direction(seen.bearing, 0.0)};
    const double rate = 0.5 * velocity.dot(1500.0 * in - 1500.0 * back);
    for (const std::optional<double> speed : {std::optional<double>(), {1500.0}}) {
      const Localiser localiser(paths,
                                {.propagation = {.max_surface_bounces = 0, .max_bottom_bounces = 0},
                                 .depth = 1000.0,
                                 .speed = speed});
      const auto found = localiser.locate(received, places, 0.01);
      ASSERT_EQ(found.size(), 1U);
      EXPECT_LT((found[0].position - target).norm(), 0.01);
      EXPECT_NEAR(found[0].range_rate, rate, 0.01 * std::abs(rate));
      EXPECT_NEAR(found[0].struck, out.range / 1500.0, 1e-5);
      // dr/dτ and dr/d(1 − η), from their geometry
      const double turn = std::cos(out.bearing - seen.bearing);
      EXPECT_NEAR(found[0].range_slope, 1500.0 / (1.0 + turn), 0.1);
      EXPECT_NEAR(found[0].rate_slope, 750.0, 0.1);
      // dr/dβ along the ellipse of the delay: found at bearings 1 mrad to either side. The third
      // derivative's share of it is of the order of 10⁻⁶ of the range a radian.
      const auto range_at = [&](double bearing) {
        Detection turned = received;
        turned.look = direction(bearing, 0.0);
        return localiser.locate(turned, places, 0.01).at(0).range;
      };
      const double slope = (range_at(seen.bearing + 1e-3) - range_at(seen.bearing - 1e-3)) / 2e-3;
      EXPECT_GT(std::abs(slope), 500.0);
      EXPECT_NEAR(found[0].bearing_slope, slope, 1e-3 * seen.range);
    }
  }
}

/// 100 m over sand, the speed falling all the way down: at 10 km nothing comes with fewer than six
/// bounces off the bottom.
Environment downward() {
  Environment ocean;
  const std::vector<double> depth = {0.0, 100.0}, speed = {1530.0, 1490.0};
  ocean.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  ocean.bottom = {.depth = 100.0,
                  .material = FluidHalfSpace{
                      .speed = 1700.0, .density = 2000.0, .attenuation_db_per_wavelength = 0.5}};
  return ocean;
}

// The loudest pair of paths to a target there is placed where the target is, to the metre that two
// kinds of path may differ by, by as many bounces as there is sound in; by three there is no place.
TEST(LocaliserTest, FollowsAsManyBouncesAsThereIsSoundIn) {
  const PropagationPaths paths(downward(), {});
  SonarPlaces places;
  places.source.position = places.array.start.position = {0.0, 0.0, 50.0};
  places.shape = {.kind = ArrayKind::volume, .length = 2.0, .width = 2.0, .height = 2.0};
  const Vec3 target(0.0, 10e3, 50.0);
  const Arrivals there =
      paths.find(places.source.position, target, 1000.0, limits_of(PropagationSettings{}, 20));
  const auto loudest =
      std::max_element(there.begin(), there.end(), [](const Arrival& a, const Arrival& b) {
        return std::abs(a.amplitude) < std::abs(b.amplitude);
      });
  ASSERT_GE(loudest->bottom_bounces, 6);
  const Detection received{.time = 2.0 * loudest->delay,
                           .look = direction(0.0, -loudest->launch_elevation)};
  const Localiser all(paths, {.frequency = 1000.0, .depth = 50.0});
  const auto found = all.locate(received, places, 0.05);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].position - target).norm(), 1.0);
  EXPECT_EQ(found[0].bottom_bounces, 2 * loudest->bottom_bounces);
  EXPECT_FALSE(all.lacks_bounces());
  const Localiser few(paths, {.frequency = 1000.0,
                              .propagation = {.max_surface_bounces = 3, .max_bottom_bounces = 3},
                              .depth = 50.0});
  EXPECT_TRUE(few.locate(received, places, 0.05).empty());
}

// A guide without loss has more bounces than are tabulated, and the receiver says so.
TEST(LocaliserTest, SaysWhereBouncesHaveNoEnd) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  ocean.bottom = {.depth = 10.0, .material = Rigid{}};
  const PropagationPaths paths(ocean, {});
  SonarPlaces places;
  places.source.position = places.array.start.position = {0.0, 0.0, 5.0};
  const Localiser localiser(paths, {.frequency = 1000.0, .depth = 4.0, .ranges = 20});
  const Detection received{.time = 2.0, .look = Vec3::UnitY()};
  static_cast<void>(localiser.locate(received, places, 0.05));
  EXPECT_TRUE(localiser.lacks_bounces());
}

// A vehicle at 10 m/s sets out east when it pings and turns north 4 s later; the echo comes at 6 s,
// 40 m east and 20 m north of the ping. Found is where it came from, seen from there; on a straight
// course it would be 28 m beside it.
TEST(LocaliserTest, FollowsTheWaypointsOfARecord) {
  const Track vehicle{.start = {},
                      .waypoints = {{.time = 50.0, .position = {0.0, 0.0, 990.0}},
                                    {.time = 104.0, .position = {540.0, 0.0, 990.0}},
                                    {.time = 200.0, .position = {540.0, 960.0, 990.0}}}};
  SonarPlaces places;
  places.array = vehicle.since(100.0, {0.0, 0.0, 10.0});
  const Vec3 at_ping = places.array.at(0.0).position;
  EXPECT_EQ(at_ping, Vec3(500.0, 0.0, 1000.0));
  const Kinematics received = places.array.at(6.0);
  EXPECT_LT((received.position - Vec3(540.0, 20.0, 1000.0)).norm(), 1e-9);
  EXPECT_LT((received.velocity - Vec3(0.0, 10.0, 0.0)).norm(), 1e-9);
  places.source.position = at_ping;
  places.shape = {.kind = ArrayKind::volume, .length = 2.0, .width = 2.0, .height = 2.0};
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  ocean.bottom = {.depth = 4000.0, .material = Rigid{}};
  const PropagationPaths paths(ocean, {});
  const Localiser localiser(
      paths, {.propagation = {.max_surface_bounces = 0, .max_bottom_bounces = 0}, .depth = 1000.0});
  // A target whose way out and back, to where it is received, takes 6 s.
  const Vec3 ahead = direction(radians(30.0), 0.0);
  double range = 4500.0;
  const auto delay = [&] {
    const Vec3 target = received.position + range * ahead;
    return (range + (target - places.source.position).norm()) / 1500.0;
  };
  for (int i = 0; i < 20; ++i) range += 0.5 * 1500.0 * (6.0 - delay());
  const Detection d{.time = 6.0, .look = ahead};
  const auto found = localiser.locate(d, places, 0.01);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].position - received.position - range * ahead).norm(), 0.01);
  SonarPlaces straight = places;
  straight.array.waypoints.clear();
  EXPECT_GT((localiser.locate(d, straight, 0.01).at(0).position - found[0].position).norm(), 15.0);
}

// A vehicle at 10 m/s listens with one phone: the range found is from where it received, 50 m
// nearer.
TEST(Scoring, MeasuresRangesFromWhereTheArrayReceived) {
  const std::vector<TrueEcho> echoes{{.target = 0, .time = 5.0, .doppler = 1.0}};
  const std::vector<TrueTarget> targets{
      {.target = 0, .present = true, .position = {0.0, 3750.0, 0.0}}};
  Detection found = at(5.0, 1.0, Vec3::UnitY());
  found.locations = {{.position = {0.0, 3700.0, 0.0}, .range = 3703.0, .bearing = std::nan("")}};
  const Track array{.start = {.position = Vec3::Zero(), .velocity = {0.0, 10.0, 0.0}},
                    .waypoints = {}};
  const PingScore score =
      score_detections(std::vector{found}, echoes, targets, ArrayShape{}, array,
                       {.time = 0.1, .doppler = 0.1, .direction = 2.0}, 1.0, 20.0);
  ASSERT_EQ(score.hits, 1);
  EXPECT_NEAR(score.targets[0].range_error, 3.0, 1e-9);
}

}  // namespace
}  // namespace asdic::detail
