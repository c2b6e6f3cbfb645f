#include "sonar/scenario/target.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sonar/echoes/echo.h"
#include "sonar/echoes/target_response.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

// East is starboard of a bow that points north; a heading of 90° turns both.
TEST(Target, BodyAxesTurnWithTheHeading) {
  EXPECT_LT((from_body({10.0, 2.0, 1.0}, 0.0) - Vec3(2.0, 10.0, 1.0)).norm(), 1e-12);
  EXPECT_LT((from_body({10.0, 2.0, 1.0}, radians(90.0)) - Vec3(10.0, -2.0, 1.0)).norm(), 1e-12);
}

TEST(Target, HeadsWhereItGoes) {
  Target target;
  target.track.start.velocity = {1.0, 1.0, 0.0};
  EXPECT_NEAR(degrees(heading_of(target, 7.0)), 45.0, 1e-12);
  target.heading = radians(10.0);
  EXPECT_NEAR(degrees(heading_of(target, 7.0)), 10.0, 1e-12);
  Target turning;  // east, a rest, then south
  turning.track.waypoints = {
      {0.0, {0, 0, 0}}, {10.0, {10, 0, 0}}, {20.0, {10, 0, 0}}, {30.0, {10, -10, 0}}};
  for (const auto& [time, heading] :
       {std::pair{-5.0, 90.0}, {5.0, 90.0}, {15.0, 90.0}, {25.0, 180.0}, {50.0, 180.0}})
    EXPECT_NEAR(degrees(heading_of(turning, time)), heading, 1e-9) << time;
}

TEST(Aspect, IsThatOfTheBisector) {
  const Vec3 north(0, 1, 0), east(1, 0, 0);
  // Sound comes from the north (travels south) and goes back there: the bow of a body that heads
  // north, the starboard beam of one that heads west.
  EXPECT_NEAR(aspect_of(-north, north, 0.0), 0.0, 1e-12);
  EXPECT_NEAR(degrees(aspect_of(-north, north, radians(-90.0))), 90.0, 1e-9);
  // From the north and to the east: the bisector is north-east; the same exchanged.
  EXPECT_NEAR(degrees(aspect_of(-north, east, 0.0)), 45.0, 1e-9);
  EXPECT_NEAR(degrees(aspect_of(-east, north, 0.0)), 45.0, 1e-9);
  EXPECT_NEAR(degrees(aspect_of(-north, -north, radians(30.0))), 330.0, 1e-9) << "forward";
}

TEST(AspectTable, IsStraightInDecibelsAndClosesOnItself) {
  const AspectTable sides{{0.0, 0.5 * pi, pi}, {10.0, 25.0, 8.0}};
  EXPECT_DOUBLE_EQ(sides.at(0.25 * pi), 17.5);
  EXPECT_DOUBLE_EQ(sides.at(-0.25 * pi), 17.5) << "port as starboard";
  EXPECT_DOUBLE_EQ(sides.at(pi), 8.0);
  const AspectTable around{{radians(30.0), radians(300.0)}, {0.0, 9.0}};
  EXPECT_NEAR(around.at(radians(345.0)), 4.5, 1e-9) << "half way from 300° to 390°";
  EXPECT_NEAR(around.at(radians(15.0)), 1.5, 1e-9);
}

TEST(Hull, HidesWhatLiesBehindMostOfABeam) {
  const Hull hull{.length = 100.0, .beam = 10.0};
  const Vec3 bow(50, 0, 0), stern(-50, 0, 0), port(0, -5, 0);
  EXPECT_FALSE(hidden(hull, bow, 0.0));
  EXPECT_TRUE(hidden(hull, stern, 0.0)) << "the hull is in the way";
  EXPECT_FALSE(hidden(hull, stern, pi));
  for (const Vec3& end : {bow, stern}) EXPECT_FALSE(hidden(hull, end, 0.5 * pi)) << "abeam";
  EXPECT_TRUE(hidden(hull, port, 0.5 * pi)) << "from starboard";
  EXPECT_FALSE(hidden(hull, port, 1.5 * pi));
  EXPECT_FALSE(hidden(hull, Vec3::Zero(), 0.5 * pi)) << "half a beam";
  // A chord of the ellipse from the stern at angle a is 2(cos a/A)/(cos²a/A² + sin²a/B²), A = 50,
  // B = 5: three quarters of a beam at a = 20.0°.
  EXPECT_TRUE(hidden(hull, stern, radians(15.0)));
  EXPECT_FALSE(hidden(hull, stern, radians(25.0)));
}

Scenario fluctuating(Fluctuation kind, int scan) {
  Scenario s = support::two_platforms();
  s.targets = {{.fluctuation = kind, .scan_pings = scan}};
  return s;
}

// N = 20 000 draws. Power of Swerling 1 and 2: mean 1, variance 1; of 3 and 4: variance ½. The mean
// errs by √(var/N) = 0.007 rms, the variance by √((μ₄ − var²)/N): μ₄ = 9 gives 0.020, and for
// chi-square with 4 degrees (μ₄ = 1.5) 0.008. Five sigma each. A wrong model fails: the variances
// are 0.5 apart.
TEST(Swerling, PowersHaveTheirMeanAndVariance) {
  for (const auto& [kind, variance, sigma] :
       {std::tuple{Fluctuation::swerling_2, 1.0, 0.020}, {Fluctuation::swerling_4, 0.5, 0.008}}) {
    const Scenario s = fluctuating(kind, 1);
    double sum = 0.0, squares = 0.0;
    std::complex<double> phases = 0.0;
    constexpr int n = 20000;
    for (int ping = 1; ping <= n; ++ping) {
      const auto w = fluctuation(s, 0, -1, {.ping = ping, .own_ping = ping});
      sum += std::norm(w);
      squares += std::norm(w) * std::norm(w);
      phases += w / std::abs(w);
    }
    const double mean = sum / n;
    EXPECT_NEAR(mean, 1.0, 5.0 * std::sqrt(variance / n));
    EXPECT_NEAR(squares / n - mean * mean, variance, 5.0 * sigma);
    EXPECT_LT(std::abs(phases) / n, 5.0 / std::sqrt(double(n))) << "uniform phase";
  }
}

TEST(Swerling, OneAndThreeLastAScanTwoAndFourAPing) {
  for (const Fluctuation kind : {Fluctuation::swerling_1, Fluctuation::swerling_3}) {
    const Scenario s = fluctuating(kind, 4);
    const auto at = [&](int ping) {
      return fluctuation(s, 0, 2, {.ping = ping, .own_ping = ping});
    };
    EXPECT_EQ(at(1), at(4));
    EXPECT_EQ(at(5), at(8));
    EXPECT_NE(at(4), at(5));
  }
  for (const Fluctuation kind : {Fluctuation::swerling_2, Fluctuation::swerling_4}) {
    const Scenario s = fluctuating(kind, 4);
    const auto at = [&](int ping, int highlight = 0, int platform = 0) {
      return fluctuation(s, 0, highlight, {.platform = platform, .ping = ping, .own_ping = ping});
    };
    EXPECT_NE(at(1), at(2));
    EXPECT_NE(at(1), at(1, 1)) << "another highlight";
    EXPECT_NE(at(1), at(1, 0, 1)) << "seen from elsewhere";
    EXPECT_EQ(at(3), at(3));
  }
  EXPECT_EQ(fluctuation(fluctuating(Fluctuation::none, 1), 0, 0, {}), 1.0);
}

// Draws of a target's fluctuation, and of the scattering of its echoes by a rough sea, belong to
// the target and not to its place in the list. Synthesis is linear up to rounding, 1e-6 of the
// peak.
TEST(Targets, AreReceivedTogetherAsAlone) {
  Scenario s = support::two_platforms();
  s.environment.bottom.depth = 200.0;
  s.environment.surface.roughness.rms_height = 0.5;
  s.arrays[0].platform = 0;
  s.propagation.max_surface_bounces = 1;
  s.propagation.direct_blast = false;
  s.pings.recording_duration = 2.0;
  const auto target = [](const char* name, double north) {
    return Target{.name = name,
                  .track = {.start = {.position = {0.0, north, 60.0}}},
                  .fluctuation = Fluctuation::swerling_2};
  };
  const auto received = [&](std::vector<Target> targets) {
    s.targets = std::move(targets);
    return PingSimulator(s).sound(1).pressure;
  };
  const Target near = target("near", 700.0), far = target("far", 900.0);
  const std::vector<float> both = received({near, far}), one = received({near}),
                           other = received({far});
  double off = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < both.size(); ++i) {
    off = std::max(off, std::abs(double(both[i]) - double(one[i]) - double(other[i])));
    peak = std::max(peak, std::abs(double(both[i])));
  }
  EXPECT_GT(peak, 0.0);
  EXPECT_LT(off, 1e-5 * peak);
  s.targets = {target("twin", 700.0), target("twin", 900.0)};
  EXPECT_NE(target_identity(s, 0), target_identity(s, 1));
}

// The loudest of an echo across the band is that of its direct paths, whatever is received seconds
// later off a floor 5 km down. 1e-4 dB is the rounding of samples in single precision.
TEST(Summary, PeakAcrossTheBandIsThatOfTheLoudestPaths) {
  Scenario s = support::two_platforms();
  s.arrays[0].platform = 0;
  s.propagation.direct_blast = false;
  s.propagation.band = BandOfLosses::wide;
  s.targets = {{.name = "target", .track = {.start = {.position = {0.0, 700.0, 60.0}}}}};
  s.pings.recording_duration = 1.5;
  const auto peak_db = [&](int bottom_bounces) {
    s.propagation.max_bottom_bounces = bottom_bounces;
    return PingSimulator(s).simulate(1).summary.at(0).echo_peak_db;
  };
  EXPECT_NEAR(peak_db(1), peak_db(0), 1e-4);
}

/// What comes back of the first target.
TargetEchoes received(const Scenario& s) {
  const PropagationPaths paths(s.environment, s.transect);
  const BeamPattern pattern(s.transmitters[0], 1.5);
  return target_echoes(
      {.paths = paths, .geometry = PingGeometry(s, {}, 1), .pattern = pattern, .frequency = 1000.0},
      0);
}

// Straight rays in open water: the echo of a highlight comes when sound has gone to that place
// itself and back. Over 3 km a body of 60 m bends the fronts by L²/(8rc)·2 = 0.2 ms·10⁻³ at most:
// d²/(2rc) a way, 30²/(2·3000·1500) = 0.1 ms off its axis; along the line of sight nothing.
TEST(Highlights, AnswerFromTheirPlaces) {
  Scenario s = support::two_platforms();
  s.platforms[1].track.start.position = {0.0, 0.0, 100.0};
  s.targets = {{.name = "submarine",
                .track = {.start = {.position = {0.0, 3000.0, 100.0}}},
                .heading = radians(30.0),
                .highlights = {{.offset = {30.0, 0.0, 0.0}, .strength_db = 10.0},
                               {.offset = {-30.0, 1.0, 2.0}, .strength_db = 4.0}}}};
  const TargetEchoes found = received(s);
  ASSERT_EQ(found.echoes.size(), 2U);
  for (const EchoPath& echo : found.echoes) {
    const Highlight& one = s.targets[0].highlights[std::size_t(echo.highlight)];
    const Vec3 place = Vec3(0.0, 3000.0, 100.0) + from_body(one.offset, radians(30.0));
    const Vec3 ship(0.0, 0.0, 100.0);
    const double exact = 2.0 * (place - ship).norm() / 1500.0;
    const double across = std::hypot(place.x(), place.z() - 100.0);
    EXPECT_NEAR(echo.received.delay, exact, across * across / (3000.0 * 1500.0) * 1.1);
    EXPECT_NEAR(echo.level_db, 200.0 - 40.0 * std::log10(3000.0) + one.strength_db, 1e-6);
  }
}

/// When something is met that moves: t with |place(t) − from| = c·(t − left).
template <class Place>
double met(const Vec3& from, double left, const Place& place) {
  double t = left;
  for (int i = 0; i < 60; ++i) t = left + (place(t) - from).norm() / 1500.0;
  return t;
}

// Sound goes to each glint of a body that moves where that is by then, and on to an array that
// moves: solved for straight rays by iteration. All in one line the fronts are plane to their body,
// and times are met to 1e-7 s on each of two legs. At rest 100 m of body are 133.3 ms; what these
// velocities do to that, some 2 ms, is what is tested.
TEST(Highlights, OfAMovingBodyAreMetWhereTheyAreByThen) {
  Scenario s = support::two_platforms();
  s.platforms[0].track.start = {.position = {0.0, 0.0, 100.0}, .velocity = {0.0, 10.0, 0.0}};
  s.platforms[1].track.start = {.position = {0.0, -500.0, 100.0}, .velocity = {0.0, 8.0, 0.0}};
  s.targets = {
      {.name = "submarine",
       .track = {.start = {.position = {0.0, 3000.0, 100.0}, .velocity = {0.0, -15.0, 0.0}}},
       .highlights = {{.offset = {50.0, 0.0, 0.0}}, {.offset = {-50.0, 0.0, 0.0}}}}};
  const TargetEchoes found = received(s);
  ASSERT_EQ(found.echoes.size(), 2U);
  for (const EchoPath& echo : found.echoes) {
    const double ahead = s.targets[0].highlights[std::size_t(echo.highlight)].offset.x();
    const auto glint = [&](double t) -> Vec3 { return {0.0, 3000.0 - ahead - 15.0 * t, 100.0}; };
    const auto ear = [](double t) -> Vec3 { return {0.0, -500.0 + 8.0 * t, 100.0}; };
    const double struck = met({0.0, 0.0, 100.0}, 0.0, glint);
    EXPECT_NEAR(echo.received.delay, met(glint(struck), struck, ear), 3e-7) << ahead;
    EXPECT_NEAR(echo.struck, 3000.0 / 1515.0, 1e-6) << "the reference point";
  }
}

}  // namespace
}  // namespace asdic::detail
