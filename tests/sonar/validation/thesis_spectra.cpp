#include <gtest/gtest.h>

#include "support/listen.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// An echo over one straight path, no noise: 3 km, received from 4.0 to 5.0 s.
PingRecord straight_echo(PulseSettings pulse) {
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(1500.0));
  s.arrays[0] = line_array(1, 0.1875, 0.0, 0.0);
  s.targets = {support::target({3000.0, 0.0, 4500.0}, 30.0)};
  s.pulse = std::move(pulse);
  s.pings.recording_start = 3.5;
  s.pings.recording_duration = 2.0;
  return PingSimulator(std::move(s)).simulate(1);
}

/// Frequency in a window of 60 ms around t [Hz].
double ridge(const Baseband& received, double t) {
  return support::frequency(received, support::broadside(received), t - 0.03, t + 0.03);
}

// 5.2.5, Figures 5-41 and 5-42: the CW stays at 4 kHz; the LFM runs from 3950 to 4050 Hz in a
// straight line. The slope of the phase over w = 60 ms weights the frequency by the power, sin⁴ πt
// under a Hann window, of relative slope 4π cot πt: it reads 100 Hz/s · 4π cot(πt) · w²/12 towards
// the louder side (1.16 Hz at 0.1 s), which is added to the straight line; the next order is a
// tenth of that, so ±0.2 Hz.
TEST(ThesisSpectrograms, CwStaysAndLfmRunsInAStraightLine) {
  const Baseband cw = support::demodulate(straight_echo({.waveform = Cw{}}), 4000.0, 200.0);
  const Baseband lfm = support::demodulate(straight_echo({.waveform = Lfm{}}), 4000.0, 200.0);
  for (int i = 1; i <= 9; ++i) {
    const double t = 0.1 * i;
    const double bias = 100.0 * 4.0 * pi / std::tan(pi * t) * 0.06 * 0.06 / 12.0;
    EXPECT_NEAR(ridge(cw, 4.0 + t), 4000.0, 0.02) << t;
    EXPECT_NEAR(ridge(lfm, 4.0 + t), 3950.0 + 100.0 * t + bias, 0.2) << t;
  }
}

class ThesisDoppler : public testing::TestWithParam<double> {};

// Figures 5-43 and 5-44: a target near the surface 30 km away that comes or goes at 7 m/s; the ray
// leaves the vehicle horizontally (0.1°), so Snell's invariant is 1/c(4500 m), Munk's law by hand,
// and the echo is (1 + v/c)/(1 − v/c) of 4 kHz: 36.45 Hz (first order 36.28, with 1500 m/s 37.33).
// The spectrum's centroid in the band of the echo alone: ±0.05 Hz, of which the reverberation 36 Hz
// away takes its Hann side lobes, below −90 dB.
TEST_P(ThesisDoppler, TheEchoIsShiftedTheReverberationIsNot) {
  const double v = GetParam();  // towards the vehicle
  Scenario s = support::thesis(SoundSpeedProfile::munk());
  s.arrays[0] = line_array(1, 0.1875, 0.0, 0.0);
  s.targets = {support::target({30000.0, 0.0, 125.0}, 60.0, {-v, 0.0, 0.0})};
  s.reverberation.enabled = true;
  s.pings.recording_duration = 44.0;
  const PingRecord record = PingSimulator(std::move(s)).simulate(1);
  const double eta = 2.0 * (4500.0 - 1300.0) / 1300.0;
  const double c = 1500.0 * (1.0 + 0.00737 * (eta - 1.0 + std::exp(-eta)));
  const double expected = 4000.0 * ((1.0 + v / c) / (1.0 - v / c) - 1.0);
  EXPECT_NEAR(std::abs(expected), v > 0.0 ? 36.45 : 36.12, 0.005);

  const double time = record.echoes.at(0).received.delay;
  const Baseband echo = support::demodulate(record, 4000.0 + expected, 10.0);
  const double received =
      support::frequency(echo, support::broadside(echo), time, time + 1.0) - 4000.0;
  EXPECT_NEAR(received, expected, 0.05);
  RecordProperty("received_hz", std::to_string(received));
  // Reverberation before the echo: a Gaussian process under the pulse's spectrum, centroid of rms
  // width 1/(√3 T) = 0.58 Hz over some ten independent pulses' lengths: 0.2 Hz; five sigma.
  const Baseband both = support::demodulate(record, 4000.0, 100.0);
  EXPECT_NEAR(support::frequency(both, support::broadside(both), 10.0, time - 1.0), 4000.0, 1.0);
  // In its own second the echo is louder than what is left at 4 kHz: they were resolved.
  const Baseband still = support::demodulate(record, 4000.0, 10.0);
  EXPECT_GT(support::peak(echo, support::broadside(echo), time, time + 1.0).level_db,
            support::peak(still, support::broadside(still), time, time + 1.0).level_db);
}

INSTANTIATE_TEST_SUITE_P(ClosingAndOpening, ThesisDoppler, testing::Values(7.0, -7.0));

}  // namespace
}  // namespace asdic::detail
