// Sonars whose rays are turned sideways.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "raytrace/volume/transect_volume.h"
#include "raytrace/volume/volume_eigenrays.h"
#include "sonar/paths/shared_propagation.h"
#include "sonar/ping/run_pings.h"
#include "support/deep.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

constexpr double slope = 0.05, bearing = 0.7, c = 1500.0;

/// Uniform water over a floor that rises to the shore, 4 km from the platform along the transect,
/// and a target across that slope.
Scenario shore() {
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(c));
  s.environment.bottom = {.depth = 200.0, .material = Rigid{}};
  s.environment.bottom.shape =
      BoundaryShape(std::vector{-60000.0, 3999.0}, std::vector{3200.0, 0.05},
                    ShapeInterpolation::piecewise_linear);
  s.transect = {.x = 0.0, .y = 0.0, .bearing = bearing};
  s.platforms[0].track.start.position = {0.0, 0.0, 100.0};
  const double across = bearing + 0.5 * pi;
  s.targets = {support::target({4000.0 * std::sin(across), 4000.0 * std::cos(across), 60.0}, 10.0)};
  s.transmitters[0].source_level_db = 220.0;
  s.pulse.duration = 0.1;
  s.arrays[0] = line_array(2, 0.1875, 0.0, 0.0);
  s.noise.law.reset();
  s.propagation.dimension = 3;
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 3;
  s.pings.recording_duration = 8.0;
  return s;
}

/// One image of the wedge: delay, and the slowness that arrives at the receiver, as (along the
/// transect, across it, down).
struct Image {
  double delay;
  Vec3 arrives;
  int surface = 0, bottom = 0;
};

/// Of a straight line unfolded over the mirrors, as tests/raytrace/validation/perfect_wedge.cpp.
/// Places are (range along the transect, across, depth); the shore is at 4000 m.
std::vector<Image> images(const Vec3& from, const Vec3& to) {
  const double wedge = std::atan(slope);
  const auto polar = [](const Vec3& x) {
    return std::pair(std::hypot(4000.0 - x.x(), x.z()), std::atan2(x.z(), 4000.0 - x.x()));
  };
  const auto [rs, source] = polar(from);
  const auto [rr, receiver] = polar(to);
  std::vector<Image> all;
  for (int j = -3; j <= 3; ++j)
    for (const double sign : {1.0, -1.0}) {
      const double angle = 2.0 * j * wedge + sign * receiver;
      Image image{};
      const int low = int(std::floor(std::min(angle, source) / wedge)),
                high = int(std::floor(std::max(angle, source) / wedge));
      for (int k = low + 1; k <= high; ++k) ++(k % 2 == 0 ? image.surface : image.bottom);
      if (image.surface > 3 || image.bottom > 3) continue;
      const double out = rr * std::cos(angle) - rs * std::cos(source),
                   down = rr * std::sin(angle) - rs * std::sin(source), along = to.y() - from.y();
      const double length = std::sqrt(out * out + down * down + along * along);
      image.delay = length / c;
      // back from the copy: turned by 2jθ, and mirrored where it is a mirror's
      const double turn = 2.0 * j * wedge;
      const double back = out * std::cos(turn) + down * std::sin(turn),
                   below = sign * (-out * std::sin(turn) + down * std::cos(turn));
      image.arrives = Vec3(-back, along, below) / (length * c);
      all.push_back(image);
    }
  return all;
}

/// In the frame of the transect: (along, across, down).
Vec3 in_frame(const Vec3& map) {
  return {map.x() * std::sin(bearing) + map.y() * std::cos(bearing),
          map.x() * std::cos(bearing) - map.y() * std::sin(bearing), map.z()};
}

// Every echo is two images of the wedge, and arrives at the array from where they stand.
TEST(ThreeDimensions, EchoesArriveFromWhereTheirRaysDo) {
  const Scenario s = shore();
  const Vec3 source = in_frame(s.platforms[0].track.start.position),
             target = in_frame(s.targets[0].track.start.position);
  const std::vector<Image> out = images(source, target), home = images(target, source);
  const PingRecord record = PingSimulator(s).simulate(1);
  ASSERT_EQ(record.echoes.size(), out.size() * home.size());
  double turned = 0.0;
  for (const EchoPath& echo : record.echoes) {
    const Vec3 slowness = in_frame(echo.received.slowness);
    const bool known = std::any_of(out.begin(), out.end(), [&](const Image& a) {
      return std::any_of(home.begin(), home.end(), [&](const Image& b) {
        return std::abs(a.delay + b.delay - echo.received.delay) < 1e-8 &&
               (b.arrives - slowness).norm() < 1e-8 / c * 1e2;
      });
    });
    EXPECT_TRUE(known) << echo.received.delay << " s";
    turned = std::max(turned, std::abs(std::atan2(slowness.x(), -slowness.y())));
  }
  EXPECT_GT(turned, radians(2.0));  // from the straight line
}

// The transmitter's pattern is asked where a ray leaves, which is not along the straight line.
TEST(ThreeDimensions, PatternsAreThoseOfTheWayARayLeaves) {
  const Scenario s = shore();
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  const auto out = std::find_if(record.legs.begin(), record.legs.end(), [](const Leg& leg) {
    return leg.kind == Leg::Kind::source_to_target;
  });
  ASSERT_NE(out, record.legs.end());
  for (const EchoPath& echo : record.echoes) {
    const Arrival& path = out->arrivals[std::size_t(echo.outgoing)];
    EXPECT_NEAR(
        std::remainder(echo.response.bearing - out->bearing - path.launch_deflection, 2.0 * pi),
        0.0, 1e-12);
    // rays up the slope leave towards the shore, against the straight line
    if (path.bottom_bounces > 0) {
      EXPECT_GT(std::abs(path.launch_deflection), 1e-3);
    }
  }
}

// Target and platform move: each pair of paths against a fixed-point iteration that searches the
// volume anew, 1 µs.
TEST(ThreeDimensions, DelaysOfMovingTargetsAreThoseOfAFixedPoint) {
  Scenario s = shore();
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.platforms[0].track.start.velocity = {1.5, 2.0, 0.0};
  s.targets[0].track.start.velocity = {7.0, -3.0, 0.0};
  const PingRecord record = PingSimulator(s).simulate(1);
  ASSERT_GE(record.echoes.size(), 9U);
  const TransectVolume volume(s.environment, s.transect);
  const VolumeTracer tracer(volume, 4000.0);
  const auto delay = [&](const Vec3& from, const Vec3& to, const Arrival& like) {
    double best = infinity, found = 0.0;
    for (const Arrival& a : volume_eigenrays(tracer, from, to, limits_of(s.propagation)))
      if (a.surface_bounces == like.surface_bounces && a.bottom_bounces == like.bottom_bounces &&
          std::abs(a.launch_elevation - like.launch_elevation) < best) {
        best = std::abs(a.launch_elevation - like.launch_elevation);
        found = a.delay;
      }
    return found;
  };
  const std::size_t step = support::deep() ? 1 : 4;  // a search a moment and echo
  for (std::size_t n = 1; n < record.echoes.size(); n += step) {
    const EchoPath& echo = record.echoes[n];
    const Arrival& out = record.legs[0].arrivals[std::size_t(echo.outgoing)];
    const Arrival& home = record.legs[1].arrivals[std::size_t(echo.returning)];
    const Vec3 source = s.platforms[0].track.at(0.0).position;
    double struck = out.delay, received = struck + home.delay;
    for (int round = 0; round < 3; ++round)
      struck = delay(source, s.targets[0].track.at(struck).position, out);
    const Vec3 at = s.targets[0].track.at(struck).position;
    for (int round = 0; round < 3; ++round)
      received = struck + delay(at, s.platforms[0].track.at(received).position, home);
    EXPECT_NEAR(echo.received.delay, received, 1e-6) << echo.outgoing << ' ' << echo.returning;
  }
}

// Ends that have moved by metres: what is followed is what a search finds there.
TEST(ThreeDimensions, FollowedPathsAreThoseFound) {
  const Scenario s = shore();
  const PropagationPaths paths(s.environment, s.transect, nullptr, nullptr,
                               volume_of(s.environment, s.transect, nullptr, 3));
  ASSERT_NE(paths.volume(), nullptr);
  const PathLimits limits = limits_of(s.propagation);
  const Vec3 from = s.platforms[0].track.start.position, to = s.targets[0].track.start.position,
             near = to + Vec3(2.0, -1.5, 0.3);
  const Arrivals before = paths.find(from, to, 4000.0, limits),
                 found = paths.find(from, near, 4000.0, limits),
                 followed = paths.follow(before, from, near, 4000.0, limits);
  ASSERT_EQ(followed.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(followed[i].delay, found[i].delay, 1e-10);
    EXPECT_NEAR(followed[i].launch_deflection, found[i].launch_deflection, 1e-7);
    EXPECT_LT(std::abs(followed[i].amplitude - found[i].amplitude),
              1e-6 * std::abs(found[i].amplitude));
  }
}

// Nothing turns rays sideways in a layered ocean: the same bits with either setting.
TEST(ThreeDimensions, ALayeredOceanIsThatOfPlanes) {
  Scenario s = shore();
  s.environment.bottom.shape.reset();
  const PingRecord three = PingSimulator(s).simulate(1);
  s.propagation.dimension = 2;
  const PingRecord two = PingSimulator(s).simulate(1);
  ASSERT_EQ(three.echoes.size(), two.echoes.size());
  for (std::size_t i = 0; i < two.echoes.size(); ++i) {
    EXPECT_EQ(three.echoes[i].received.delay, two.echoes[i].received.delay);
    EXPECT_EQ(three.echoes[i].received.amplitude, two.echoes[i].received.amplitude);
  }
}

}  // namespace
}  // namespace asdic::detail
