// Echoes of targets that no ray reaches, against wave theory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/waves/diffraction.h"
#include "sonar/ping.h"
#include "sonar/warnings/warnings.h"
#include "support/csv.h"
#include "support/two_platforms.h"

namespace asdic {
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
  s.pulse.start_frequency = frequency - 25.0;
  s.pulse.end_frequency = frequency + 25.0;
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
    EXPECT_NEAR(record.echoes[0].heard.delay, 2.0 * 10000.0 / 1510.9, 0.02);
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
  EXPECT_NEAR(echo.heard.doppler, (1.0 + mach) / (1.0 - mach), 2e-6);
  EXPECT_NEAR(echo.struck, (10000.0 - 5.0 * echo.struck) / 1510.9, 0.01);
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
}  // namespace asdic
