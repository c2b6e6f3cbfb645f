// The channel to an array: closed forms of straight tracks, and the ping's own pressure.
#include "sonar/channel/channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

constexpr double c = 1500.0;

/// Two platforms in still deep water, the sender under way.
Scenario straight_ways(const Vec3& velocity) {
  Scenario s = support::two_platforms();
  s.environment = {.water = SoundSpeedProfile::isovelocity(c), .bottom = {.depth = 5000.0}};
  s.environment.surface.material = ReflectionTable{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};
  s.environment.bottom.material = ReflectionTable{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};
  s.targets.clear();
  s.wind_speed = 0.0;
  s.platforms[0].track.start = {.position = {0.0, 0.0, 2000.0}, .velocity = velocity};
  s.platforms[1].track.start = {.position = {300.0, 0.0, 2000.0}, .velocity = Vec3::Zero()};
  s.transmitters[0].platform = 0;
  s.transmitters[0].offset = Vec3::Zero();
  s.arrays[0].platform = 1;
  s.arrays[0].offset = Vec3::Zero();
  s.arrays[0].phones = {Vec3::Zero(), {0.0, 5.0, 3.0}};
  s.pulse = {.waveform = Cw{.frequency = 3000.0}, .duration = 0.2, .window = PulseWindow::hann};
  s.propagation = {};
  s.propagation.max_surface_bounces = 0;
  s.propagation.max_bottom_bounces = 0;
  s.reverberation.enabled = false;
  s.noise.law = WhiteNoise{-200.0};
  s.pings.recording_start = 0.1;
  s.pings.recording_duration = 0.5;
  s.pings.sample_rate = 12000.0;
  return s;
}

// A sender that passes at 20 m/s: what leaves at t arrives |r(t)|/c later, to a nanosecond over 20
// s.
TEST(Channel, AStraightWayIsItsLength) {
  const PingSimulator simulator(straight_ways({20.0, 3.0, 0.0}));
  const Channel found = channel(simulator, {.duration = 20.0, .step = 1.0});
  ASSERT_EQ(found.phones.size(), 2U);
  EXPECT_TRUE(found.warnings.empty());
  for (std::size_t n = 0; n < 2; ++n) {
    ASSERT_EQ(found.phones[n].size(), 1U);
    const ChannelPath& path = found.phones[n][0];
    const Vec3 phone = Vec3(300.0, 0.0, 2000.0) + (n == 0 ? Vec3(0, 0, 0) : Vec3(0.0, 5.0, 3.0));
    for (std::size_t i = 0; i < found.times.size(); ++i) {
      const Vec3 from = Vec3(0.0, 0.0, 2000.0) + found.times[i] * Vec3(20.0, 3.0, 0.0);
      const Vec3 way = phone - from;
      EXPECT_NEAR(path.delay[i], way.norm() / c, 2e-9) << found.times[i];
      EXPECT_NEAR(std::abs(path.amplitude[i]) * way.norm(), 1.0, 0.01) << found.times[i];
      EXPECT_NEAR(path.doppler[i], 1.0 / (1.0 - Vec3(20.0, 3.0, 0.0).dot(way) / way.norm() / c),
                  1e-7)
          << found.times[i];
    }
  }
}

// A tone through it at a time is the tone when it was sent: brute force, sample by sample.
TEST(Channel, ASignalIsReceivedWhenItComes) {
  const PingSimulator simulator(straight_ways({20.0, 3.0, 0.0}));
  const Channel found = channel(simulator, {.duration = 2.0, .step = 0.5});
  const double rate = 12000.0, f = 2500.0;
  std::vector<double> tone;
  for (int i = 0; i < 24000; ++i) {
    const double edge = std::min(1.0, std::min(i, 23999 - i) / 2400.0);
    tone.push_back(std::pow(std::sin(0.5 * pi * edge), 2) * std::cos(2.0 * pi * f * i / rate));
  }
  const ChannelOutput out = through(found, tone, rate);
  double worst = 0.0;
  for (std::size_t k = 0; k < out.samples; ++k) {
    const double t = out.start + double(k) / rate;
    double sent = t - 0.2;  // t = sent + |r(sent)|/c
    for (int i = 0; i < 40; ++i)
      sent = t - (Vec3(300.0, 0.0, 0.0) - sent * Vec3(20.0, 3.0, 0.0)).norm() / c;
    const double way = (Vec3(300.0, 0.0, 0.0) - sent * Vec3(20.0, 3.0, 0.0)).norm();
    const double x = sent * rate, edge = std::min(1.0, std::min(x, 23999.0 - x) / 2400.0);
    const double truth =
        edge > 0.0 ? std::pow(std::sin(0.5 * pi * edge), 2) * std::cos(2.0 * pi * f * sent) / way
                   : 0.0;
    worst = std::max(worst, std::abs(double(out.pressure[k]) - truth));
  }
  EXPECT_LT(worst, 1e-3 / 260.0);
}

// Its pulse through the channel is the ping: −60 dB, in shallow water under way, with amplitudes as
// a ping has them.
TEST(Channel, ThePulseThroughItIsThePing) {
  Scenario s = straight_ways({2.0, 5.0, 0.0});
  s.environment.surface.material = Vacuum{};
  s.environment.bottom = {
      .depth = 60.0,
      .material =
          FluidHalfSpace{.speed = 1650.0, .density = 1900.0, .attenuation_db_per_wavelength = 0.8}};
  s.platforms[0].track.start.position.z() = 35.0;
  s.platforms[1].track.start.position.z() = 20.0;
  s.propagation.max_surface_bounces = 3;
  s.propagation.max_bottom_bounces = 3;
  s.propagation.exact_per_phone = true;
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  const Channel found = channel(simulator, {.duration = 0.2, .held = true});
  const double rate = s.pings.sample_rate;
  const double peak = std::sqrt(2.0) * amplitude_from_db(s.transmitters[0].source_level_db) * 1e-6;
  std::vector<double> pulse;
  for (int i = 0; i <= 2400; ++i)
    pulse.push_back(peak * simulator.pulse().analytic(i / rate).real());
  const ChannelOutput out = through(found, pulse, rate);
  const auto first = std::lround((s.pings.recording_start - out.start) * rate);
  double off = 0.0, all = 0.0;
  for (std::size_t n = 0; n < 2; ++n)
    for (std::size_t k = 0; k < record.recording.samples; ++k) {
      const double p = double(record.pressure[n * record.recording.samples + k]);
      const auto at = static_cast<std::ptrdiff_t>(k) + first;
      const double q = at >= 0 && at < static_cast<std::ptrdiff_t>(out.samples)
                           ? double(out.pressure[n * out.samples + static_cast<std::size_t>(at)])
                           : 0.0;
      off += (p - q) * (p - q);
      all += p * p;
    }
  EXPECT_GT(all, 0.0);
  EXPECT_LT(db_from_power(off / all), -60.0);
}

TEST(Channel, SaysWhatItLeavesOut) {
  Scenario s = straight_ways(Vec3::Zero());
  s.environment.surface.roughness = {.rms_height = 0.5};
  const PingSimulator simulator(s);
  const Channel found = channel(simulator, {.duration = 0.1});
  EXPECT_THAT(found.warnings, testing::Contains(testing::HasSubstr("rough boundaries")));
  const std::vector<double> long_signal(12000, 1.0);
  EXPECT_THROW(static_cast<void>(through(found, long_signal, 12000.0)), InputError);
}

// 40 kHz of band over 3 km of sea water: decibels; 10 Hz: none.
TEST(Channel, KnowsWhatAbsorptionDoesAcrossABand) {
  Scenario s = straight_ways(Vec3::Zero());
  s.platforms[1].track.start.position.x() = 3000.0;
  s.environment.absorption = Thorp{};
  const PingSimulator simulator(s);
  const Channel found = channel(simulator, {.duration = 0.1});
  EXPECT_GT(absorption_error_db(found, s.environment, {.low = 1000.0, .high = 40000.0}), 10.0);
  EXPECT_LT(absorption_error_db(found, s.environment, {.low = 2995.0, .high = 3005.0}), 0.01);
  std::vector<double> tone;
  for (int i = 0; i < 12000; ++i) tone.push_back(std::cos(2.0 * pi * 3000.0 * i / 12000.0 + 0.3));
  const SignalBand band = band_of(tone, 12000.0);
  EXPECT_NEAR(band.low, 3000.0, 20.0);
  EXPECT_NEAR(band.high, 3000.0, 20.0);
}

}  // namespace
}  // namespace asdic::detail
