#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "raytrace/ocean/slice.h"
#include "support/thesis.h"

namespace asdic {
namespace {

/// A wedge: 900 m deep south of the origin, rising to 300 m at 12 km along 30 degrees, under a
/// summer profile.
Scenario wedge() {
  Scenario s = support::thesis(SoundSpeedProfile::table(std::vector{0.0, 60.0, 200.0, 900.0},
                                                        std::vector{1520.0, 1516.0, 1496.0, 1500.0},
                                                        Interpolation::c_linear));
  s.environment.bottom = {.depth = 900.0, .material = FluidHalfSpace{}};
  s.environment.bottom.shape = BoundaryShape(std::vector{0.0, 12000.0}, std::vector{900.0, 300.0},
                                             ShapeInterpolation::piecewise_linear);
  s.transect = {.x = -200.0, .y = 100.0, .bearing = radians(30.0)};
  s.platform.start.position = {500.0, 1200.0, 150.0};
  s.targets = {support::target({4000.0, 4000.0, 100.0}, 10.0)};
  s.transmitter.source_level_db = 220.0;
  s.pulse.duration = 0.1;
  s.array = line_array(2, 0.1875, 0.0, 0.0);
  s.noise.spectral_level_db.reset();
  s.reverberation.enabled = false;
  s.propagation.max_surface_bounces = 2;
  s.propagation.max_bottom_bounces = 2;
  s.pings.recording_duration = 12.0;
  return s;
}

/// The plane through two places by hand: the sea floor where the line is, node by node.
EigenraySolver by_hand(const Scenario& s, const Vec3& from, const Vec3& to) {
  const Vec2 way = (to - from).head<2>(),
             unit(std::sin(s.transect.bearing), std::cos(s.transect.bearing));
  const double cosine = way.dot(unit) / way.norm();
  const double x0 = (from.head<2>() - Vec2(s.transect.x, s.transect.y)).dot(unit);
  std::vector<double> range, depth;
  for (const auto& [x, z] : {std::pair{0.0, 900.0}, std::pair{12000.0, 300.0}}) {
    range.push_back((x - x0) / cosine);
    depth.push_back(z);
  }
  if (cosine < 0.0) {
    std::reverse(range.begin(), range.end());
    std::reverse(depth.begin(), depth.end());
  }
  Environment plane = s.environment;
  plane.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  plane.bottom.depth = plane.bottom.shape->depth_at(0.0);
  return EigenraySolver(plane);
}

double range(const Vec3& a, const Vec3& b) { return (b - a).head<2>().norm(); }

Arrivals paths_by_hand(const Scenario& s, const Vec3& from, const Vec3& to) {
  return by_hand(s, from, to)
      .find(from.z(), to.z(), range(from, to), 4000.0, limits_of(s.propagation));
}

// Nothing moves: an echo is a path up the slope times a path down it, both found in planes written
// down by hand. Delays and levels to rounding of the nodes (10⁻¹² of 10⁴ m).
TEST(Transect, EchoFromUpslopeIsThePathsThereAndBack) {
  const Scenario s = wedge();
  const Vec3 source = s.platform.start.position, target = s.targets[0].track.start.position;
  const Arrivals out = paths_by_hand(s, source, target), back = paths_by_hand(s, target, source);
  const PingRecord record = PingSimulator(s).simulate(1);
  ASSERT_GE(out.size(), 5U);
  ASSERT_EQ(record.echoes.size(), out.size() * back.size());
  for (const EchoPath& echo : record.echoes) {
    const Arrival &a = out[std::size_t(echo.outgoing)], &b = back[std::size_t(echo.returning)];
    EXPECT_NEAR(echo.heard.delay, a.delay + b.delay, 1e-9);
    const std::complex<double> amplitude = a.amplitude * b.amplitude * amplitude_from_db(10.0);
    EXPECT_LT(std::abs(echo.heard.amplitude - amplitude), 1e-6 * std::abs(amplitude));
    EXPECT_NEAR(echo.level_db, 220.0 + db_from_amplitude(std::abs(amplitude)), 1e-5);
  }
}

// The way back is the way out reversed, though every leg was searched in a plane of its own: delays
// to 1e-9 s. Amplitudes are those of a sea that is the same all around the source (N × 2D): over a
// slope a ray's horizontal slowness ξ changes, and reversed tubes differ in width across the plane
// by ξ_source/ξ_receiver, amplitudes by its root; to 1e-5, for they are derivatives.
TEST(Transect, ReciprocityOverASlope) {
  const Scenario s = wedge();
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  const Arrivals &out = record.legs.at(0).arrivals, &back = record.legs.at(1).arrivals;
  const double c_source = simulator.paths().speed_at(s.platform.start.position),
               c_target = simulator.paths().speed_at(s.targets[0].track.start.position);
  ASSERT_EQ(out.size(), back.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_NEAR(out[i].delay, back[i].delay, 1e-9);
    EXPECT_NEAR(out[i].launch_elevation, -back[i].arrival_elevation, 1e-7);
    const double widths = std::cos(out[i].launch_elevation) / c_source /
                          (std::cos(out[i].arrival_elevation) / c_target);
    EXPECT_LT(std::abs(out[i].amplitude - back[i].amplitude * std::sqrt(widths)),
              1e-5 * std::abs(out[i].amplitude));
  }
}

/// The delay of the path like `like` between two places [s].
double delay_of(const Scenario& s, const Vec3& from, const Vec3& to, const Arrival& like) {
  double best = infinity, delay = 0.0;
  for (const Arrival& a : paths_by_hand(s, from, to)) {
    if (a.surface_bounces != like.surface_bounces || a.bottom_bounces != like.bottom_bounces)
      continue;
    const double miss = std::abs(a.launch_elevation - like.launch_elevation);
    if (miss < best) best = miss, delay = a.delay;
  }
  return delay;
}

// Target and vehicle move across the slope: every path pair against a fixed-point iteration that
// searches each plane anew and linearises nothing, 1 µs.
TEST(Transect, DelaysOfMovingTargetsAreThoseOfAFixedPoint) {
  Scenario s = wedge();
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.platform.start.velocity = {1.5, 2.0, 0.0};
  s.targets[0].track.start.velocity = {7.0, -3.0, 0.0};
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  ASSERT_GE(record.echoes.size(), 9U);
  for (const EchoPath& echo : record.echoes) {
    const Arrival& out = record.legs[0].arrivals[std::size_t(echo.outgoing)];
    const Arrival& home = record.legs[1].arrivals[std::size_t(echo.returning)];
    const Vec3 source = s.platform.at(0.0).position;
    double struck = out.delay, heard = struck + home.delay;
    for (int i = 0; i < 4; ++i)
      struck = delay_of(s, source, s.targets[0].track.at(struck).position, out);
    const Vec3 at = s.targets[0].track.at(struck).position;
    for (int i = 0; i < 4; ++i)
      heard = struck + delay_of(s, at, s.platform.at(heard).position, home);
    EXPECT_NEAR(echo.heard.delay, heard, 1e-6) << echo.outgoing << ' ' << echo.returning;
  }
}

// A flat sea floor drawn with two nodes is marched over, a flat one is not: the same echoes to
// 1e-6, in delay and in amplitude.
TEST(Transect, AFlatShapeIsTheLayeredOcean) {
  Scenario layered = wedge();
  layered.environment.bottom.shape.reset();
  Scenario shaped = layered;
  shaped.environment.bottom.shape =
      BoundaryShape(std::vector{-5000.0, 9000.0}, std::vector{900.0, 900.0},
                    ShapeInterpolation::piecewise_linear);
  const PingRecord a = PingSimulator(layered).simulate(1), b = PingSimulator(shaped).simulate(1);
  ASSERT_EQ(a.echoes.size(), b.echoes.size());
  ASSERT_GE(a.echoes.size(), 25U);
  for (std::size_t i = 0; i < a.echoes.size(); ++i) {
    EXPECT_NEAR(a.echoes[i].heard.delay, b.echoes[i].heard.delay, 1e-6);
    EXPECT_LT(std::abs(a.echoes[i].heard.amplitude - b.echoes[i].heard.amplitude),
              1e-6 * std::abs(a.echoes[i].heard.amplitude));
  }
}

}  // namespace
}  // namespace asdic
