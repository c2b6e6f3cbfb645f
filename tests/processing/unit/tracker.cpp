#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/random.h"
#include "core/units.h"
#include "processing/assignment.h"
#include "processing/tracker.h"

namespace asdic::detail {
namespace {

// Against every permutation of small problems.
TEST(Assignment, IsTheCheapestOfAll) {
  RandomStream draw(1, Draw::ambient_noise, 0, 0);
  for (int run = 0; run < 200; ++run) {
    const int rows = 1 + static_cast<int>(4.0 * draw.uniform()),
              columns = 1 + static_cast<int>(4.0 * draw.uniform());
    std::vector<double> cost(static_cast<std::size_t>(rows * columns));
    for (double& x : cost) x = draw.uniform() < 0.3 ? infinity : draw.uniform();
    const auto value = [&](const std::vector<int>& column) {  // pairs, then the sum
      double sum = 0.0;
      int pairs = 0;
      for (int i = 0; i < rows; ++i)
        if (column[static_cast<std::size_t>(i)] >= 0) {
          sum += cost[static_cast<std::size_t>(i * columns + column[static_cast<std::size_t>(i)])];
          ++pairs;
        }
      return std::pair(-pairs, sum);
    };
    std::vector<int> order(4), best_column(static_cast<std::size_t>(rows), -1);
    std::iota(order.begin(), order.end(), 0);
    std::pair<int, double> best{0, 0.0};
    do {
      std::vector<int> column(static_cast<std::size_t>(rows), -1);
      for (int i = 0; i < rows; ++i) {
        const int j = order[static_cast<std::size_t>(i)];
        if (j < columns && std::isfinite(cost[static_cast<std::size_t>(i * columns + j)]))
          column[static_cast<std::size_t>(i)] = j;
      }
      best = std::min(best, value(column));
    } while (std::next_permutation(order.begin(), order.end()));
    const auto found = value(assign(cost, rows, columns));
    EXPECT_EQ(found.first, best.first);
    EXPECT_NEAR(found.second, best.second, 1e-12);
  }
}

/// What a platform at rest at the origin measures of a thing, with errors.
Contact measure(const Vec2& position, const Vec2& velocity, double time, RandomStream& error,
                int detection) {
  Contact c{.detection = detection, .time = time};
  c.bearing_sigma = radians(0.5);
  c.range_sigma = 30.0;
  c.range_rate_sigma = 0.2;
  c.bearing = std::atan2(position.x(), position.y()) + c.bearing_sigma * error.normal();
  c.range = position.norm() + c.range_sigma * error.normal();
  c.range_rate = velocity.dot(position.normalized()) + c.range_rate_sigma * error.normal();
  return c;
}

// Measured slopes of the filter's linearisation against central differences of its own prediction,
// for a bistatic pair that moves.
TEST(TrackStateTest, SlopeIsThatOfTheMeasurement) {
  Contact c{.bearing_sigma = 0.01, .range_sigma = 10.0, .range_rate_sigma = 0.1};
  c.array = {300.0, -200.0};
  c.source = {-4000.0, 1000.0};
  c.array_velocity = {1.0, 2.0};
  c.source_velocity = {-2.0, 0.5};
  TrackState state;
  state.mean << 5000.0, 7000.0, -3.0, 2.0;
  const auto slope = state.innovation(c).slope;
  for (int i = 0; i < 4; ++i) {
    const double h = i < 2 ? 1.0 : 1e-3;
    TrackState more = state, less = state;
    more.mean[i] += h;
    less.mean[i] -= h;
    // residual = measured − expected
    const Eigen::Vector3d difference =
        (less.innovation(c).residual - more.innovation(c).residual) / (2.0 * h);
    for (int row = 0; row < 3; ++row)
      EXPECT_NEAR(slope(row, i), difference[row], 1e-6 + 1e-4 * std::abs(difference[row]));
  }
}

constexpr double fifteenth = 14 * 60.0;  // contacts come every minute [s]

/// The track of fifteen contacts. \param contact  by its time
template <typename ContactAt>
TrackState after_fifteen(const ContactAt& contact) {
  TrackState state = TrackState::from(contact(0.0), 10.0);
  for (double t = 60.0; t <= fifteenth; t += 60.0) {
    const Contact c = contact(t);
    state.predict(t, 1e-4);
    state.update(state.innovation(c));
  }
  return state;
}

/// Squared error of the state then, over its covariance: 4 on average where that is right.
double normalised_error(const TrackState& state, const Vec2& start, const Vec2& velocity) {
  Eigen::Vector4d truth;
  truth << start + fifteenth * velocity, velocity;
  const Eigen::Vector4d off = state.mean - truth;
  return off.dot(state.covariance.inverse() * off);
}

// With the right model the squared, normalised errors of the state have the mean 4 (χ² of four
// degrees): over 200 runs it is within 4 ± 5·√(8/200) = ±1. With a claimed noise of a third of the
// true one it is far above: the wrong model fails.
TEST(TrackStateTest, CovarianceIsThatOfItsErrors) {
  const auto mean_square = [](double claimed) {
    double sum = 0.0;
    const int runs = 200;
    for (int run = 0; run < runs; ++run) {
      RandomStream error(3, Draw::ambient_noise, static_cast<std::uint32_t>(run), 0);
      const Vec2 start(3000.0, 8000.0), velocity(-4.0, 1.5);
      const TrackState state = after_fifteen([&](double t) {
        Contact c = measure(start + t * velocity, velocity, t, error, 0);
        c.bearing_sigma *= claimed;
        c.range_sigma *= claimed;
        c.range_rate_sigma *= claimed;
        return c;
      });
      sum += normalised_error(state, start, velocity);
    }
    return sum / runs;
  };
  EXPECT_NEAR(mean_square(1.0), 4.0, 1.0);
  EXPECT_GT(mean_square(1.0 / 3.0), 12.0);
}

/// What is left after 15 pings of a target whose contacts have errors of range that go with those
/// of range rate and bearing, over 200 runs.
struct Coupled {
  double normalised = 0.0;   ///< mean squared error of the state over its covariance
  double range_error = 0.0;  ///< root mean square [m]
};
Coupled followed(double per_rate, double per_bearing, bool told) {
  const int runs = 200;
  const Vec2 start(3000.0, 8000.0), source(-6000.0, 2000.0);
  Coupled result;
  for (int run = 0; run < runs; ++run) {
    RandomStream error(7, Draw::ambient_noise, static_cast<std::uint32_t>(run), 0);
    const Vec2 velocity(5.0 * error.normal(), 5.0 * error.normal());
    const TrackState state = after_fifteen([&](double t) {
      const Vec2 place = start + t * velocity;
      Contact c{.time = t, .bearing_sigma = radians(0.5), .range_sigma = 3.0};
      c.range_rate_sigma = 6.0;
      c.source = source;
      const double of_rate = c.range_rate_sigma * error.normal(),
                   of_bearing = c.bearing_sigma * error.normal();
      c.bearing = std::atan2(place.x(), place.y()) + of_bearing;
      c.range_rate =
          0.5 * velocity.dot(place.normalized() + (place - source).normalized()) + of_rate;
      c.range = place.norm() + c.range_sigma * error.normal() + per_rate * of_rate +
                per_bearing * of_bearing;
      if (told) {
        c.range_per_rate = per_rate;
        c.range_per_bearing = per_bearing;
      } else {
        c.range_sigma =
            std::hypot(c.range_sigma, per_rate * c.range_rate_sigma, per_bearing * c.bearing_sigma);
      }
      return c;
    });
    result.normalised += normalised_error(state, start, velocity) / runs;
    const double range = (start + fifteenth * velocity).norm();
    result.range_error += std::pow(state.mean.head<2>().norm() - range, 2) / runs;
  }
  result.range_error = std::sqrt(result.range_error);
  return result;
}

// A sweep whose ridge turns 6 m/s of range rate into 30 m of range, where its cell alone is 3 m.
// Told of it the filter's errors are those it claims, 4 ± 1 as above (to the first order, without
// the range's curvature, they are 10). Pings a minute apart know the rate to centimetres a second
// and so take the 30 m back: the end of a straight line through 15 ranges of 3 m is known to
// 3·2/√15 = 1.6 m, asked for within half as much again (200 runs tell it to 5 %); through ranges of
// 30 m to 16 m.
TEST(TrackStateTest, ASweepsRangeGoesWithItsRangeRate) {
  const Coupled told = followed(-5.0, 0.0, true), silent = followed(-5.0, 0.0, false);
  EXPECT_NEAR(told.normalised, 4.0, 1.0);
  EXPECT_LT(told.range_error, 2.4);
  EXPECT_GT(silent.range_error, 10.0);
}

// A bistatic pair's range goes with its bearing along the ellipse of the delay, 4 km a radian, 35 m
// for half a degree: two errors of one origin tell more of the place than two of their own. (To the
// first order the squared errors are 13.)
TEST(TrackStateTest, ABistaticRangeGoesWithItsBearing) {
  const Coupled told = followed(0.0, -4000.0, true), silent = followed(0.0, -4000.0, false);
  EXPECT_NEAR(told.normalised, 4.0, 1.0);
  EXPECT_LT(told.range_error, 0.8 * silent.range_error);
}

struct Sea {
  std::vector<std::vector<Contact>> pings;
  std::vector<double> times;
};
/// Two targets that cross, each seen nine times in ten, among `clutter` false alarms a ping.
Sea two_targets(int clutter, std::uint32_t run) {
  Sea sea;
  RandomStream draw(17, Draw::ambient_noise, run, 0);
  for (int k = 0; k < 25; ++k) {
    const double t = 60.0 * k;
    std::vector<Contact> contacts;
    const Vec2 v1(4.0, 0.0), v2(-3.0, -2.0);
    if (draw.uniform() < 0.9)
      contacts.push_back(measure(Vec2(-3000.0, 8000.0) + t * v1, v1, t, draw, 1));
    if (draw.uniform() < 0.9)
      contacts.push_back(measure(Vec2(2500.0, 9500.0) + t * v2, v2, t, draw, 2));
    for (int i = 0; i < clutter; ++i) {
      const double range = 1000.0 + 14000.0 * draw.uniform(), bearing = 2.0 * pi * draw.uniform();
      const Vec2 place = range * Vec2(std::sin(bearing), std::cos(bearing));
      Contact c = measure(place, Vec2::Zero(), t, draw, 100 + i);
      c.range_rate = 20.0 * (draw.uniform() - 0.5);
      contacts.push_back(c);
    }
    sea.pings.push_back(contacts);
    sea.times.push_back(t);
  }
  return sea;
}

TEST(TrackerTest, FollowsTwoCrossingTargetsThroughClutter) {
  for (std::uint32_t run = 0; run < 10; ++run) {
    const Sea sea = two_targets(5, run);
    const auto tracks = track_contacts(sea.pings, sea.times, {});
    for (const auto& [start, velocity] : {std::pair(Vec2(-3000.0, 8000.0), Vec2(4.0, 0.0)),
                                          std::pair(Vec2(2500.0, 9500.0), Vec2(-3.0, -2.0))}) {
      int covered = 0;
      for (const ContactTrack& track : tracks)
        for (const TrackPoint& p : track.points) {
          const Vec2 truth = start + p.time * velocity;
          if ((p.position - truth).norm() < 300.0 && (p.velocity - velocity).norm() < 3.0)
            ++covered;
        }
      EXPECT_GE(covered, 18) << run;  // of 25, two or three of which go before a track is believed
    }
    // False alarms everywhere make few tracks, and short ones.
    EXPECT_LE(tracks.size(), 5U) << run;
  }
}

TEST(TrackerTest, StartsByMOfNAndStopsAfterMisses) {
  RandomStream draw(5, Draw::ambient_noise, 0, 0);
  const Vec2 start(0.0, 5000.0), velocity(2.0, 1.0);
  const auto run = [&](const std::vector<int>& seen) {
    std::vector<std::vector<Contact>> pings;
    std::vector<double> times;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const double t = 30.0 * static_cast<double>(k);
      times.push_back(t);
      pings.emplace_back();
      if (seen[k] != 0) pings.back().push_back(measure(start + t * velocity, velocity, t, draw, 0));
    }
    return track_contacts(pings, times, {.start_hits = 3, .start_pings = 4, .stop_misses = 3});
  };
  EXPECT_EQ(run({1, 0, 1, 0, 0, 0, 0}).size(), 0U);  // two of four
  EXPECT_EQ(run({1, 1, 0, 1, 0, 0, 0}).size(), 1U);  // three of four
  EXPECT_EQ(run({1, 0, 0, 1, 0, 0, 1, 0, 0, 1}).size(), 0U);
  const auto kept = run({1, 1, 1, 0, 0, 1, 1});  // two misses do not end it
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].points.size(), 7U);
  EXPECT_EQ(kept[0].points[3].detection, -1);
  const auto two = run({1, 1, 1, 0, 0, 0, 1, 1, 1});  // three do
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0].points.size(), 3U);  // ends with its last hit
}

}  // namespace
}  // namespace asdic::detail
