#include "sonar/ping/stream_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sonar/echoes/direct_blast.h"
#include "sonar/ping/run_pings.h"
#include "sonar/scenario/sampling.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

using support::two_platforms;

TEST(Transmissions, AreThoseOfAllTransmittersInTheOrderInWhichTheyAreSent) {
  Scenario s = two_platforms();
  s.pings.count = 2;
  s.pings.elevations = {0.1, 0.2};
  s.transmitters.push_back(s.transmitters[0]);
  s.transmitters[1].first_ping_time = 0.5;
  s.transmitters[1].interval = 1.0;
  s.transmitters[1].elevations = {0.3};
  const std::vector<Transmission> sent = transmissions(s);
  ASSERT_EQ(sent.size(), 4U);
  const std::vector<double> times{0.0, 0.5, 1.5, 2.0}, elevations{0.1, 0.3, 0.3, 0.2};
  const std::vector<int> who{0, 1, 1, 0}, own_ping{1, 1, 2, 2};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(sent[i].time, times[i]);
    EXPECT_DOUBLE_EQ(sent[i].elevation, elevations[i]);
    EXPECT_EQ(sent[i].transmitter, who[i]);
    EXPECT_EQ(sent[i].own_ping, own_ping[i]);
  }
}

TEST(Transmissions, OfAStreamLeaveAtWholeSamples) {
  Scenario s = two_platforms();
  s.pings.count = 3;
  s.pings.interval = 1.00007;
  s.pings.continuous = true;
  for (const Transmission& one : transmissions(s)) {
    const double samples = one.time * s.pings.sample_rate;
    EXPECT_NEAR(samples, std::round(samples), 1e-9);
  }
}

// The truth: every ping simulated alone, added up at the sample where it left.
TEST(Stream, IsTheSumOfItsPingsWithoutGaps) {
  for (const Samples kind : {Samples::pressure, Samples::baseband}) {
    Scenario s = two_platforms();
    s.pings.count = 4;
    s.pings.interval = 0.7;  // each ping is still received under the next four
    s.pings.continuous = true;
    s.pings.samples = kind;
    s.noise = {};
    const PingSimulator simulator(s);
    const std::size_t width = kind == Samples::baseband ? 2 : 1;
    const double rate = recorded_rate(s);

    std::vector<std::vector<float>> rows(channels_of(s));
    std::size_t longest = 0;
    EXPECT_EQ(run_pings(simulator,
                        [&](PingRecord&& record) {
                          const std::size_t n = record.recording.samples * width;
                          longest = std::max(longest, record.recording.samples);
                          for (std::size_t c = 0; c < rows.size(); ++c)
                            rows[c].insert(rows[c].end(),
                                           record.pressure.begin() + std::ptrdiff_t(c * n),
                                           record.pressure.begin() + std::ptrdiff_t((c + 1) * n));
                        }),
              4);
    EXPECT_EQ(longest, longest_stream_part(s));

    std::vector<std::vector<float>> expected(rows.size());
    for (int ping = 1; ping <= 4; ++ping) {
      const PingRecord alone = simulator.sound(ping);
      const auto first =
          static_cast<std::size_t>(std::llround(simulator.transmission(ping).time * rate)) * width;
      const std::size_t n = alone.recording.samples * width;
      for (std::size_t c = 0; c < rows.size(); ++c) {
        expected[c].resize(std::max(expected[c].size(), first + n), 0.0F);
        for (std::size_t i = 0; i < n; ++i) expected[c][first + i] += alone.pressure[c * n + i];
      }
    }
    float loudest = 0.0F;
    for (std::size_t c = 0; c < rows.size(); ++c) {
      ASSERT_EQ(rows[c].size(), expected[c].size());
      for (std::size_t i = 0; i < rows[c].size(); ++i) {
        loudest = std::max(loudest, std::abs(rows[c][i]));
        ASSERT_FLOAT_EQ(rows[c][i], expected[c][i]);
      }
    }
    EXPECT_GT(loudest, 0.0F);
  }
}

/// The furthest that Re{b·e^{i2πf_c t}} of a complex record is from pressure, over its peak.
double furthest_from_pressure(const PingRecord& complex, const PingRecord& real, double carrier) {
  const std::size_t n = complex.recording.samples;
  const double rate = complex.recording.sample_rate;
  const double step = real.recording.sample_rate / rate;
  EXPECT_EQ(step, std::round(step));
  double peak = 0.0, worst = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t at = 2 * (c * n + i);
      const std::complex<double> b(complex.pressure[at], complex.pressure[at + 1]);
      const double p = (b * std::polar(1.0, 2.0 * pi * carrier * double(i) / rate)).real();
      const double q =
          real.pressure[c * real.recording.samples + i * static_cast<std::size_t>(step)];
      peak = std::max(peak, std::abs(q));
      worst = std::max(worst, std::abs(p - q));
    }
  EXPECT_GT(peak, 0.0);
  return worst / peak;
}

// p = Re{b e^{i2πf_c t}}, at the samples that both have: rates 8000 and 400 Hz.
TEST(ComplexBaseband, IsThePressureAboutItsCarrier) {
  Scenario s = two_platforms();
  s.platforms[0].track.start.velocity = {3.0, 4.0, 0.0};
  const PingRecord real = PingSimulator(s).simulate(1);
  for (const double carrier : {1000.0, 987.3}) {
    s.pings.samples = Samples::baseband;
    s.pings.carrier = carrier;
    s.pings.baseband_rate = 400.0;
    // −80 dB, the synthesis' own bound
    EXPECT_LT(furthest_from_pressure(PingSimulator(s).simulate(1), real, carrier), 1e-4);
  }
}

// By default too: what lies outside the band is below 2e-4 by a bound, as if all phases were alike;
// of these pulses half of it is found.
TEST(ComplexBaseband, IsThePressureAtItsDefaultRate) {
  for (const PulseWindow window : {PulseWindow::hann, PulseWindow::tukey})
    for (const AnyWaveform& waveform : {AnyWaveform(Cw{1000.0}), AnyWaveform(Lfm{970.0, 1030.0})}) {
      Scenario s = two_platforms();
      s.platforms[0].track.start.velocity = {3.0, 4.0, 0.0};
      s.pulse = {.waveform = waveform, .duration = 0.4, .window = window, .tukey_fraction = 0.5};
      s.pings.samples = Samples::baseband;
      const double rate = recorded_rate(s);
      const PingRecord complex = PingSimulator(s).simulate(1);
      s.pings.samples = Samples::pressure;
      s.pings.sample_rate = 40.0 * rate;
      EXPECT_LT(furthest_from_pressure(complex, PingSimulator(s).simulate(1), 1000.0), 1e-4)
          << static_cast<int>(window) << " at " << rate;
    }
}

// At the lowest rate allowed the band is cut where a Hann tone is 40 dB down. The filter rings for
// 39/(flat width) and no longer: before the first arrival and after the last there is silence.
TEST(ComplexBaseband, CutToItsLeastRateRingsBrieflyAndNotAroundTheRecord) {
  Scenario s = two_platforms();
  s.targets.clear();
  s.pings.recording_duration = 20.0;
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 0.5};
  s.pings.samples = Samples::baseband;
  const Band band = received_band(s, Pulse(s.pulse));
  s.pings.baseband_rate = std::ceil(band.highest - band.lowest);
  const PingRecord record = PingSimulator(s).simulate(1);
  const std::size_t n = record.recording.samples;
  const double rate = record.recording.sample_rate;
  const auto level = [&](std::size_t i) {
    return std::hypot(double(record.pressure[2 * i]), double(record.pressure[2 * i + 1]));
  };
  double peak = 0.0, silence = 0.0;
  std::size_t loudest = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (level(i) > peak) peak = level(i), loudest = i;
  const double rings = 0.25 + 39.0 * 1.3 / (rate - 2.0);  // from the middle of the pulse [s]
  for (std::size_t i = 0; i < n; ++i)
    if (std::abs(double(i) - double(loudest)) / rate > rings + 1.0)
      silence = std::max(silence, level(i));
  EXPECT_GT(peak, 0.0);
  EXPECT_LT(silence, 1e-5 * peak) << "the brick wall before: 2e-3";
}

TEST(ComplexBaseband, HasARateThatHoldsTheBandByDefault) {
  Scenario s = two_platforms();
  s.pings.samples = Samples::baseband;
  const Band band = received_band(s, Pulse(s.pulse));
  EXPECT_GT(recorded_rate(s), band.highest - band.lowest);
  EXPECT_DOUBLE_EQ(recorded_carrier(s), Pulse(s.pulse).centre_frequency());
}

TEST(Blanking, SilencesTheTransmittersOwnPlatformWhileItTransmits) {
  Scenario s = two_platforms();
  s.noise.law = WhiteNoise{80.0};
  s.pings.blanking = true;
  s.arrays.push_back(line_array(2, 0.5, 0.0, 0.0));  // on the ship
  const PingRecord record = PingSimulator(s).simulate(1);
  const std::size_t n = record.recording.samples, deaf = 1600;  // 0.2 s
  ASSERT_EQ(record.pressure.size(), 5 * n);
  for (std::size_t c = 0; c < 5; ++c) {
    const float* row = record.pressure.data() + c * n;
    const bool silent = std::all_of(row, row + deaf, [](float p) { return p == 0.0F; });
    EXPECT_EQ(silent, c >= 3) << "channel " << c;
    EXPECT_NE(row[deaf], 0.0F);
  }
}

// The ship sends from 0 to 0.2 s and the buoy from 0.13 s on; the ship's second transmitter at 0.15
// s: until 0.35 s the ship's array is deaf, until 0.33 s the buoy's, and neither for the other's
// pulse. White noise is nowhere else exactly 0.
TEST(Blanking, LastsInAStreamAsLongAsAnyTransmitterOfThePlatformSends) {
  Scenario s = two_platforms();
  s.noise.law = WhiteNoise{80.0};
  s.pings.blanking = true;
  s.pings.continuous = true;
  s.pings.recording_duration = 0.5;
  s.arrays.push_back(line_array(2, 0.5, 0.0, 0.0));  // on the ship
  s.transmitters.push_back(s.transmitters[0]);
  s.transmitters[1].platform = 1;
  s.transmitters[1].first_ping_time = 0.13;
  s.transmitters.push_back(s.transmitters[0]);
  s.transmitters[2].first_ping_time = 0.15;
  for (const Samples kind : {Samples::pressure, Samples::baseband}) {
    s.pings.samples = kind;
    const std::size_t width = kind == Samples::baseband ? 2 : 1;
    std::vector<std::vector<bool>> silent(5);
    double rate = 0.0;
    EXPECT_EQ(run_pings(PingSimulator(s),
                        [&](PingRecord&& record) {
                          rate = record.recording.sample_rate;
                          const std::size_t n = record.recording.samples;
                          for (std::size_t c = 0; c < 5; ++c)
                            for (std::size_t i = 0; i < n; ++i) {
                              const float* p = record.pressure.data() + (c * n + i) * width;
                              silent[c].push_back(
                                  std::all_of(p, p + width, [](float x) { return x == 0.0F; }));
                            }
                        }),
              3);
    for (std::size_t c = 0; c < 5; ++c)
      for (std::size_t i = 0; i < silent[c].size(); ++i) {
        const double t = double(i) / rate, begin = c < 3 ? 0.13 : 0.0, end = c < 3 ? 0.33 : 0.35;
        if (std::min(std::abs(t - begin), std::abs(t - end)) > 1.5 / rate) {
          ASSERT_EQ(silent[c][i], t > begin && t < end) << "channel " << c << " at " << t;
        }
      }
  }
}

// 1500 m of it horizontal, 200 m down: spherical spreading in open water.
TEST(DirectBlast, ComesStraightAndWithItsOwnDoppler) {
  Scenario s = two_platforms();
  s.platforms[0].track.start.velocity = {6.0, 8.0, 0.0};  // towards the buoy
  const PingRecord record = PingSimulator(s).simulate(1);
  ASSERT_EQ(record.legs.size(), 1U);
  const Leg& leg = record.legs[0];
  EXPECT_EQ(leg.kind, Leg::Kind::source_to_array);
  EXPECT_EQ(leg.array, 0);
  ASSERT_EQ(leg.arrivals.size(), 1U);
  const double distance = std::sqrt(1500.0 * 1500.0 + 200.0 * 200.0);
  EXPECT_NEAR(leg.arrivals[0].delay, distance / 1500.0, 1e-9);
  EXPECT_NEAR(std::abs(leg.arrivals[0].amplitude), 1.0 / distance, 1e-9);
  // The loudest sample of the record: 200 dB and the spreading, a peak envelope of √2 rms.
  float loudest = 0.0F;
  for (const float p : record.pressure) loudest = std::max(loudest, std::abs(p));
  const double level = 200.0 - 20.0 * std::log10(distance) + 20.0 * std::log10(std::sqrt(2.0));
  EXPECT_NEAR(20.0 * std::log10(static_cast<double>(loudest)) + 120.0, level, 0.2);

  const PropagationPaths paths(s.environment, s.transect);
  const BeamPattern pattern(s.transmitters[0], 1.5);
  const PingGeometry geometry(s, {}, 1);
  const EchoContext context{
      .paths = paths, .geometry = geometry, .pattern = pattern, .frequency = 1000.0};
  const DirectBlast blast = direct_blast(context);
  ASSERT_EQ(blast.received.size(), 1U);
  const double closing = 10.0 * 1500.0 / distance;
  EXPECT_NEAR(blast.received[0].received.doppler, 1.0 / (1.0 - closing / 1500.0), 1e-12);
}

TEST(DirectBlast, IsNotReceivedWhereItIsNotWanted) {
  Scenario s = two_platforms();
  s.propagation.direct_blast = false;
  EXPECT_TRUE(PingSimulator(s).simulate(1).legs.empty());
  s = two_platforms();
  s.arrays[0].platform = 0;  // its own platform: a metre away or less
  EXPECT_TRUE(PingSimulator(s).simulate(1).legs.empty());
}

// Truth: between two mirrors a wave that goes up and down is that of images; the ship moves along
// and down with v, so that image and array close in on each other: t = 2h/(c + w) one way, factor
// (1 + w/c)/(1 − w/c) of a single bounce off what lies below, to first order in the sideways part.
TEST(Fathometer, ReceivesWhatSurfaceAndBottomMirror) {
  Scenario s = two_platforms();
  s.arrays[0].platform = 0;
  s.propagation.fathometer = true;
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  constexpr double c = 1500.0, below = 4900.0, above = 100.0, w = 2.0, along = 10.0;
  s.platforms[0].track.start.velocity = {along, 0.0, w};
  s.pings.recording_duration = 8.0;

  const PropagationPaths paths(s.environment, s.transect);
  const BeamPattern pattern(s.transmitters[0], 1.5);
  const PingGeometry geometry(s, {}, 1);
  const EchoContext context{
      .paths = paths, .geometry = geometry, .pattern = pattern, .frequency = 1000.0};
  DirectBlast blast = direct_blast(context);
  std::sort(blast.received.begin(), blast.received.end(), [](const EchoPath& a, const EchoPath& b) {
    return a.received.delay < b.received.delay;
  });
  ASSERT_EQ(blast.received.size(), 4U);  // surface, bottom, and both in either order
  // Each image is that of the sender when it sent; the array is where it is when it receives:
  // (c t)² = (v t)² + (d ± w t)², d the sum of the ways up and down at rest.
  const auto delay = [&](double d, double closing) {
    const double a = c * c - along * along - closing * closing, b = -d * closing;
    return (b + std::sqrt(b * b + a * d * d)) / a;
  };
  const double up = delay(2.0 * above, -w), down = delay(2.0 * below, w);
  EXPECT_NEAR(blast.received[0].received.delay, up, 1e-9);
  EXPECT_NEAR(blast.received[1].received.delay, down, 1e-9);
  EXPECT_NEAR(std::abs(blast.received[0].received.amplitude), 1.0 / (c * up), 1e-9);
  EXPECT_NEAR(std::abs(blast.received[1].received.amplitude), 1.0 / (c * down), 1e-9);
  EXPECT_LT(blast.received[0].received.amplitude.real(), 0.0);  // the surface turns the sign
  EXPECT_GT(blast.received[1].received.amplitude.real(), 0.0);
  // t = c⁻¹|…| of the image, derived by the time of sending: the exact factor along each path.
  const auto factor = [&](double d, double closing) {
    const double t = delay(d, closing), h = 1e-3;
    // sent h later the sender's image is nearer by `closing` h, and the array by as much again
    return 1.0 / (1.0 + (delay(d - 2.0 * closing * h, closing) - t) / h);
  };
  EXPECT_NEAR(blast.received[0].received.doppler, factor(2.0 * above, -w), 1e-9);
  EXPECT_NEAR(blast.received[1].received.doppler, factor(2.0 * below, w), 1e-9);
}

// The straight way is left out, however far the array is towed behind.
TEST(Fathometer, LeavesOutTheStraightWay) {
  Scenario s = two_platforms();
  s.arrays[0].platform = 0;
  s.arrays[0].offset = {-200.0, 0.0, 0.0};
  s.propagation.fathometer = true;
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 2;
  const PingRecord record = PingSimulator(s).simulate(1);
  ASSERT_EQ(record.legs.size(), 1U);
  EXPECT_EQ(record.legs[0].arrivals.size(), 8U);  // s, b, sb, bs, sbs, bsb, sbsb, bsbs
  for (const Arrival& path : record.legs[0].arrivals)
    EXPECT_GT(path.surface_bounces + path.bottom_bounces, 0);
}

}  // namespace
}  // namespace asdic::detail
