#include <gtest/gtest.h>

#include "support/csv.h"
#include "support/listen.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

using support::Csv;

/// One row of Tables 5.1 and 5.2: isovelocity, one straight path at the vehicle's depth.
Scenario sonar_equation(double source_level, double strength, double range) {
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(1500.0));
  s.transmitters[0].source_level_db = source_level;
  s.targets = {support::target({range, 0.0, 4500.0}, strength)};
  s.noise.law = WhiteNoise{40.0};
  s.pings.recording_start = std::floor(2.0 * range / 1500.0) - 1.0;
  s.pings.recording_duration = 4.0;
  return s;
}

// RL = SL − 40 log₁₀ r + TS; Danesh (2013), Tables 5.1 and 5.2, in the pressure: a Hann window
// keeps the pulse's peak, so peak envelope/√2 is the level. What is left of the noise: 16 Hz of
// 40 dB/Hz less 12 dB by 16 phones is 40 dB, 41 dB below the weakest echo, 0.05 dB rms on its peak;
// cutting the Hann spectrum at 8/T takes less than 0.01 dB. ±0.2 dB is four sigma.
TEST(ThesisTables, EchoLevelsInThePressureAreTheSonarEquation) {
  const Csv tables("physics-reference/thesis_sonar_equation_tables.csv");
  ASSERT_EQ(tables.rows(), 7U);
  double worst = 0.0;
  for (std::size_t row = 0; row < tables.rows(); ++row) {
    const double range = tables["range_m"][row], expected = tables["RL_dB"][row];
    const PingSimulator simulator(
        sonar_equation(tables["SL_dB"][row], tables["TS_dB"][row], range));
    const PingRecord record = simulator.simulate(1);
    const Baseband received = support::demodulate(record, 4000.0, 8.0);
    const support::Peak echo = support::peak(received, support::broadside(received), 0.0, 100.0);
    EXPECT_NEAR(echo.level_db, expected, 0.2) << "table " << tables.text("table")[row];
    // The thesis prints whole decibels, cut or rounded.
    EXPECT_NEAR(echo.level_db, tables["thesis_RL_dB"][row], 1.2);
    EXPECT_NEAR(record.summary.at(0).echo_level_db, expected, 1e-3);  // the CSV has four digits
    EXPECT_NEAR(echo.time, 2.0 * range / 1500.0 + 0.5,
                0.05);  // of a flat top, sin² 0.05π = −0.1 dB
    worst = std::max(worst, std::abs(echo.level_db - expected));
  }
  RecordProperty("worst_db", std::to_string(worst));
}

// The same without a window and without noise: the mean square over the middle of the pulse is
// that of a tone of level RL. No filter, so only the synthesis' own error (−80 dB) and half a cycle
// of the average over 3200 count.
TEST(ThesisTables, UnwindowedToneHasTheSameRmsLevel) {
  Scenario s = sonar_equation(230.0, 30.0, 30000.0);
  s.pulse.window = PulseWindow::none;
  s.noise.law.reset();
  const PingRecord record = PingSimulator(std::move(s)).simulate(1);
  const double rate = record.recording.sample_rate;
  const auto from = static_cast<std::size_t>((40.1 - record.recording.start) * rate);
  const auto count = static_cast<std::size_t>(0.8 * rate);
  double power = 0.0;
  for (std::size_t i = from; i < from + count; ++i)
    power += static_cast<double>(record.pressure[i]) * static_cast<double>(record.pressure[i]);
  EXPECT_NEAR(db_from_power(power / double(count) / (micropascal * micropascal)), 80.9151, 0.02);
}

struct Setting {
  double source_level, strength, range, rate;
};
class ThesisNoise : public testing::TestWithParam<Setting> {};

// "The noise is a constant 40 dB across the entire spectrum regardless of source strength, target
// strength and target range" (5.2.1), and of the sampling rate. Density over octave-free bands of
// 1/8 of the spectrum: 16 phones × 3 s × fs/16 of bandwidth give at least 16·3·500 = 24 000 degrees
// of freedom (less by 1.05 for the overlap): 0.028 dB rms. 0.15 dB is five sigma (one in 10⁶).
TEST_P(ThesisNoise, IsFlatWhateverTheSettings) {
  const Setting p = GetParam();
  Scenario s = sonar_equation(p.source_level, p.strength, p.range);
  s.pings.sample_rate = p.rate;
  s.pings.recording_start -= 3.0;
  s.pings.recording_duration = 8.0;
  const PingRecord record = PingSimulator(s).simulate(1);
  const double begin = record.recording.start, end = begin + 8.0;
  const std::size_t length = 2048;
  const auto level = [&](const std::vector<double>& density, double low, double high) {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = 1; k + 1 < density.size(); ++k) {
      const double f = double(k) * p.rate / double(length);
      if (f < low || f >= high) continue;
      sum += density[k];
      count += 1.0;
    }
    return db_from_power(sum / count / (micropascal * micropascal));
  };
  const auto quiet = support::welch(record, length, begin, begin + 3.0);
  for (int band = 0; band < 8; ++band)
    EXPECT_NEAR(level(quiet, band * p.rate / 16.0, (band + 1) * p.rate / 16.0), 40.0, 0.15) << band;
  // While the echo sounds, well off its line: 4 kHz ± 500 Hz left out.
  const auto loud = support::welch(record, length, begin, end);
  EXPECT_NEAR(level(loud, 100.0, 3500.0), 40.0, 0.15);
  if (p.rate > 12000.0) {
    EXPECT_NEAR(level(loud, 4500.0, 0.5 * p.rate), 40.0, 0.15);
  }
  EXPECT_GT(level(loud, 3990.0, 4010.0), 50.0);  // and the echo is there
}

INSTANTIATE_TEST_SUITE_P(Settings, ThesisNoise,
                         testing::Values(Setting{230, 30, 30000, 16000},
                                         Setting{240, 40, 30000, 16000},
                                         Setting{240, 40, 5000, 16000},
                                         Setting{240, 40, 10000, 10000},
                                         Setting{230, 40, 20000, 32000}));

}  // namespace
}  // namespace asdic::detail
