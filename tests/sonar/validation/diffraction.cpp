// Echoes of targets that no ray reaches, against wave theory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "raytrace/propagation.h"
#include "raytrace/waves/diffraction.h"
#include "sonar/echoes/leg_response.h"
#include "sonar/ping/ping.h"
#include "sonar/warnings/warnings.h"
#include "support/csv.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

const ReflectionTable nothing_back{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};

Environment surface_duct() {
  const std::vector<double> depth = {0.0, 60.0, 160.0, 360.0, 1000.0, 5000.0};
  const std::vector<double> speed = {1510.0, 1510.96, 1500.96, 1490.96, 1487.76, 1551.76};
  return {.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear),
          .bottom = {.depth = 5000.0, .material = nothing_back}};
}

double loss(const Arrival& path) { return -db_from_amplitude(std::abs(path.amplitude)); }

// One range against means over ±500 m, where the field changes by tenths of a decibel on the way.
TEST(Diffraction, LeaksOutOfADuctAsTheTablesSay) {
  const support::Csv csv("physics-reference/leakage_duct60_windows.csv");
  const Environment ocean = surface_duct();
  int held = 0;
  for (std::size_t i = 0; i < csv.rows(); ++i) {
    if (csv["zr_m"][i] < 90.0 || csv["range_m"][i] < 9000.0) continue;
    const auto path =
        diffracted_arrival(ocean, 10.0, csv["zr_m"][i], csv["range_m"][i], csv["f_Hz"][i], {});
    ASSERT_TRUE(path) << i;
    EXPECT_EQ(path->kind, ArrivalKind::diffracted);
    EXPECT_NEAR(loss(*path), csv["TL_ffp_dB"][i], 0.5) << csv["f_Hz"][i] << csv["zr_m"][i];
    // as fast as the top of the barrier, 1510.96 m/s, and down through the thermocline
    EXPECT_NEAR(1.0 / path->horizontal_slowness, 1510.9, 0.25);
    EXPECT_NEAR(path->delay, csv["range_m"][i] / 1510.9, 0.02);
    const double c = ocean.water.at(csv["zr_m"][i]).c;
    EXPECT_NEAR(path->arrival_elevation, -std::acos(c / 1510.9), radians(0.2));
    ++held;
  }
  EXPECT_EQ(held, 12);
}

// The other way round it is the same path.
TEST(Diffraction, IsReciprocal) {
  const auto there = diffracted_arrival(surface_duct(), 10.0, 100.0, 10000.0, 1000.0, {});
  const auto back = diffracted_arrival(surface_duct(), 100.0, 10.0, 10000.0, 1000.0, {});
  ASSERT_TRUE(there && back);
  EXPECT_LT(std::abs(there->amplitude - back->amplitude), 1e-3 * std::abs(there->amplitude));
  EXPECT_NEAR(there->delay, back->delay, 1e-6);
  EXPECT_NEAR(there->arrival_elevation, -back->launch_elevation, 1e-4);
  EXPECT_NEAR(there->launch_elevation, -back->arrival_elevation, 1e-4);
}

// Where a ray gets there without the bottom, there is nothing to add; nor in silent places.
TEST(Diffraction, OnlyWhereNoRayComes) {
  const Environment ocean = surface_duct();
  const Arrivals ray(1);
  EXPECT_FALSE(diffracted_arrival(ocean, 10.0, 40.0, 10000.0, 1000.0, ray));
  Arrivals off_the_bottom(1);
  off_the_bottom[0].bottom_bounces = 1;
  off_the_bottom[0].amplitude = 1e-4;
  EXPECT_TRUE(diffracted_arrival(ocean, 10.0, 100.0, 10000.0, 1000.0, off_the_bottom));
  EXPECT_FALSE(diffracted_arrival(ocean, 10.0, 3000.0, 3000.0, 1000.0));
  off_the_bottom[0].amplitude = 1.0;
  EXPECT_FALSE(diffracted_arrival(ocean, 10.0, 100.0, 10000.0, 1000.0, off_the_bottom));
}

Scenario under_the_layer(double frequency) {
  Scenario s = support::two_platforms();
  s.environment = surface_duct();
  s.platforms[0].track.start.position = {0.0, 0.0, 10.0};
  s.platforms[1].track.start.position = {0.0, 0.0, 10.0};
  s.targets = {{.name = "boat", .track = {.start = {.position = {10000.0, 0.0, 100.0}}}}};
  s.targets[0].strength_db = 10.0;
  s.propagation.direct_blast = false;
  s.propagation.max_surface_bounces = 3;
  s.pulse.waveform = Lfm{frequency - 25.0, frequency + 25.0};
  s.pings.recording_start = 13.0;
  s.pings.recording_duration = 1.0;
  return s;
}

// 60 m layer, source 10 m, target 100 m deep, 10 km: "0 paths" before; one-way losses of 88 dB at
// 500 Hz and 87 dB at 3.5 kHz by wave theory.
TEST(Diffraction, ATargetBelowTheLayerAnswers) {
  const std::vector<std::pair<double, double>> truth = {{500.0, 88.16}, {3500.0, 87.02}};
  for (const auto& [frequency, one_way] : truth) {
    const Scenario s = under_the_layer(frequency);
    const PingRecord record = PingSimulator(s).sound(1);
    ASSERT_EQ(record.echoes.size(), 1U) << frequency;
    EXPECT_NEAR(record.echoes[0].level_db, 200.0 + 10.0 - 2.0 * one_way, 0.5);
    EXPECT_NEAR(record.echoes[0].received.delay, 2.0 * 10000.0 / 1510.9, 0.02);
    ASSERT_FALSE(record.legs.empty());
    EXPECT_EQ(record.legs[0].arrivals.at(0).kind, ArrivalKind::diffracted);
  }
  Scenario rays = under_the_layer(500.0);
  rays.propagation.diffraction = false;
  EXPECT_TRUE(PingSimulator(rays).sound(1).echoes.empty());
}

// A target under way is met where it has got to, with its Doppler.
TEST(Diffraction, ATargetUnderWayIsFollowed) {
  Scenario s = under_the_layer(500.0);
  s.targets[0].track.start.velocity = {-5.0, 0.0, 0.0};
  const PingRecord record = PingSimulator(s).sound(1);
  ASSERT_EQ(record.echoes.size(), 1U);
  const EchoPath& echo = record.echoes[0];
  const double mach = 5.0 / 1510.9;
  EXPECT_NEAR(echo.received.doppler, (1.0 + mach) / (1.0 - mach), 2e-6);
  EXPECT_NEAR(echo.struck, (10000.0 - 5.0 * echo.struck) / 1510.9, 0.01);
}

/// ∫x·e^{−i2πft}dt of real samples.
std::complex<double> spectrum_at(std::span<const float> x, double rate, double start, double f) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += double(x[i]) * std::polar(1.0, -2.0 * pi * f * (start + double(i) / rate)) / rate;
  return sum;
}

/// The whole field of the wave equation at one place, by its own integral over wavenumbers.
std::complex<double> whole_field(const Scenario& s, const Vec3& from, const Vec3& to, double f) {
  PropagationCase c;
  c.environment = s.environment;
  c.frequency = f;
  c.source_depths = {from.z()};
  c.solver = FieldSolver::waves;
  c.receivers = {.depths = {to.z()}, .ranges = {(to - from).head<2>().norm()}};
  return std::complex<double>(run(c).field.front());
}

// From 400 to 600 Hz, less sound of high frequencies passes the bottom of the layer. The ratio of
// the echo's spectrum to that of the pulse is the square of the field at every frequency, within
// 0.1 dB and 0.021 rad from 430 to 570 Hz. There `narrow` is decibels off and says so.
TEST(Diffraction, AWideBandHasTheWavesAtEveryFrequency) {
  for (const bool wide : {true, false}) {
    Scenario s = under_the_layer(500.0);
    s.pulse.waveform = Lfm{400.0, 600.0};
    s.propagation.band = wide ? BandOfLosses::wide : BandOfLosses::narrow;
    s.noise.law = WhiteNoise{-200.0};
    PingSimulator simulator(s);
    const PingRecord record = simulator.sound(1);
    const Pulse pulse(s.pulse);
    std::vector<float> sent;
    for (int i = 0; i < 3200; ++i)  // 0.4 s
      sent.push_back(float(std::sqrt(2.0) * pulse.analytic(i / 8000.0).real()));
    const std::span<const float> received(record.pressure.data(), record.recording.samples);
    const Vec3 place = s.targets[0].track.start.position,
               ship = s.platforms[0].track.start.position;
    double worst = 0.0, turned = 0.0;
    for (double f = 430.0; f <= 571.0; f += 20.0) {
      const std::complex<double> through = spectrum_at(received, 8000.0, 13.0, f) /
                                           spectrum_at(sent, 8000.0, 0.0, f) /
                                           (amplitude_from_db(200.0 + 10.0) * 1e-6);
      const std::complex<double> truth =
          whole_field(s, ship, place, f) * whole_field(s, place, ship, f);
      worst = std::max(worst, std::abs(db_from_amplitude(std::abs(through / truth))));
      turned = std::max(turned, std::abs(std::arg(through / truth)));
    }
    std::vector<std::string> told = simulator.judge_paths().warnings;
    if (wide) {
      EXPECT_LT(worst, 0.12);
      EXPECT_LT(turned, 0.021);
      EXPECT_THAT(told, testing::Not(testing::Contains(testing::HasSubstr("propagation.band"))));
    } else {
      EXPECT_GT(worst, 1.0);
      EXPECT_THAT(told, testing::Contains(testing::HasSubstr("propagation.band: what reaches "
                                                             "target \"boat\" where no ray does")));
    }
  }
}

// Where it changes faster than frequencies are computed, the number says so.
TEST(Diffraction, AResponseIsSampledAsOftenAsItTurns) {
  const auto of_delay = [](double seconds) {
    return sampled_response(500.0, 100.0, {1e-3, 1e-3}, 33, [&](double f) {
      return std::vector{1.0 + std::polar(0.5, 2.0 * pi * f * seconds)};
    });
  };
  const SampledResponse slow = of_delay(0.002), fast = of_delay(0.1);
  EXPECT_LE(slow.values.size(), 9U);
  EXPECT_LT(slow.error, 1e-3);
  EXPECT_NEAR(std::abs(slow.at(437.0)[0] - (1.0 + std::polar(0.5, 2.0 * pi * 0.874))), 0.0, 1e-3);
  EXPECT_EQ(fast.values.size(), 33U);
  EXPECT_GT(fast.error, 0.03);
}

// Polynomials up to the degree leave out no more than half of what is tolerated.
TEST(Diffraction, AResponseHasTheDegreeOfItsPolynomial) {
  const auto degree_of = [](const std::function<std::complex<double>(double)>& response) {
    return sampled_response(500.0, 100.0, {}, 65,
                            [&](double f) { return std::vector{response((f - 500.0) / 100.0)}; })
        .degree();
  };
  EXPECT_EQ(degree_of([](double) { return 2.0; }), 0U);
  EXPECT_EQ(degree_of([](double x) { return 1.0 + 0.5 * x; }), 1U);
  EXPECT_EQ(degree_of([](double x) { return 4.0 * x * x * x - 3.0 * x; }), 3U);
  // T₄ of 1e-3 beside 1 is below 2e-3, of 4e-3 it is not.
  const auto fourth = [](double x) { return std::cos(4.0 * std::acos(std::clamp(x, -1.0, 1.0))); };
  EXPECT_EQ(degree_of([&](double x) { return 1.0 + 1e-3 * fourth(x); }), 0U);
  EXPECT_EQ(degree_of([&](double x) { return 1.0 + 4e-3 * fourth(x); }), 4U);
}

// An echo off a target at a caustic: no jump as it moves through it by centimetres, and none is
// lost beyond it.
TEST(Diffraction, ATargetMovesThroughACaustic) {
  Scenario s = under_the_layer(500.0);
  s.environment = {.water = SoundSpeedProfile::munk(),
                   .surface = {.depth = 0.0, .material = nothing_back},
                   .bottom = {.depth = 5000.0, .material = nothing_back}};
  s.propagation.max_surface_bounces = 0;
  s.pings.recording_start = 50.0;
  s.pings.recording_duration = 10.0;
  for (Platform& p : s.platforms) p.track.start.position.z() = 1000.0;
  const auto level = [&](double range) {
    s.targets[0].track.start.position = {range, 0.0, 700.0};
    const PingRecord record = PingSimulator(s).levels(1);
    EXPECT_EQ(record.echoes.size(), 4U) << range;
    return record.summary.at(0).echo_peak_db;
  };
  double edge = 41000.0, lit = 42000.0;
  while (lit - edge > 0.01) {
    const double middle = 0.5 * (edge + lit);
    const bool none = EigenraySolver(s.environment)
                          .find(1000.0, 700.0, middle, 500.0, limits_of(s.propagation))
                          .empty();
    (none ? edge : lit) = middle;
  }
  double before = level(edge - 1.0);
  for (double r = edge - 0.75; r < edge + 1.1; r += 0.25) {
    const double now = level(r);
    EXPECT_NEAR(now, before, 0.05) << r - edge;
    before = now;
  }
  EXPECT_NEAR(before,
              200.0 + 10.0 +
                  2.0 * db_from_amplitude(std::abs(
                            whole_field(s, {0, 0, 1000.0}, {edge + 1.0, 0, 700.0}, 500.0))),
              1.0);
}

// Water that bends sound down: from 3 km on the surface is reached off a poor bottom alone, and
// around the shadow's edge as much comes by diffraction, which reverberation leaves out.
TEST(Diffraction, ReverberationOfDarkGroundIsWarnedOf) {
  Scenario s = under_the_layer(500.0);
  const std::vector<double> depth = {0.0, 1500.0}, speed = {1500.0, 1430.0};
  s.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  s.environment.bottom = {.depth = 1500.0,
                          .material = ReflectionTable{{0.0, 0.5 * pi}, {0.02, 0.02}, {0.0, 0.0}}};
  s.platforms[0].track.start.position.z() = 50.0;
  s.targets.clear();
  s.reverberation.enabled = true;
  s.pings.recording_start = 0.0;
  s.pings.recording_duration = 8.0;
  const auto told = [](const Scenario& of) { return PingSimulator(of).judge_paths().warnings; };
  const auto dark = testing::Contains(testing::HasSubstr("no ray reaches the surface without"));
  EXPECT_THAT(told(s), dark);
  s.propagation.diffraction = false;
  EXPECT_THAT(told(s), testing::Not(dark));
  s.propagation.diffraction = true;
  s.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  EXPECT_THAT(told(s), testing::Not(dark));
}

// Source and target at the depth of most speed, 90 wavelengths apart: rays part there, so the
// direct sound, which the wave equation has 6 dB above the rays off surface and bottom, has no ray.
TEST(Diffraction, DirectSoundThatRaysOffTheSurfaceHideIsWarnedOf) {
  Scenario s = under_the_layer(236.0);
  const std::vector<double> depth = {0.0, 63.55, 127.1}, speed = {1495.0, 1495.41, 1494.271};
  s.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  s.environment.bottom = {.depth = 127.1, .material = FluidHalfSpace{.speed = 1600.0}};
  s.platforms[0].track.start.position.z() = 63.551;
  s.targets[0].track.start.position = {524.3, 0.0, 63.55};
  const auto told = [](const Scenario& of) { return PingSimulator(of).judge_paths().warnings; };
  const auto hidden = testing::Contains(testing::HasSubstr("no direct ray goes to or from"));
  EXPECT_THAT(told(s), hidden);
  s.targets[0].track.start.position.z() = 40.0;
  EXPECT_THAT(told(s), testing::Not(hidden));
}

// What is left out is told before anything runs.
TEST(Diffraction, WhatIsLeftOutIsWarnedOf) {
  Scenario s = under_the_layer(500.0);
  EXPECT_THAT(warnings(s), testing::Not(testing::Contains(testing::HasSubstr("left out"))));
  Scenario dear = under_the_layer(20000.0);
  dear.targets[0].track.start.position.x() = 40000.0;
  EXPECT_THAT(warnings(dear),
              testing::Contains(testing::HasSubstr("no ray reaches target \"boat\"")));
  dear.targets[0].track.start.position.z() = 30.0;  // in the duct: rays come
  dear.propagation.max_surface_bounces = 100;
  EXPECT_THAT(warnings(dear), testing::Not(testing::Contains(testing::HasSubstr("no ray"))));
  const std::vector<double> range = {0.0, 20000.0}, depth = {5000.0, 4000.0};
  s.environment.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  EXPECT_THAT(warnings(s),
              testing::Contains(testing::HasSubstr("inside the surface duct of about")));
  s.propagation.diffraction = false;
  EXPECT_THAT(warnings(s), testing::Not(testing::Contains(testing::HasSubstr("left out"))));
}

}  // namespace
}  // namespace asdic::detail
