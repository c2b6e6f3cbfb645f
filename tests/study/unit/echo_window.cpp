#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "processing/detection_threshold.h"
#include "processing/signal_excess.h"
#include "sonar/scenario/sampling.h"
#include "study/measures/echo_filter.h"
#include "study/measures/measures.h"
#include "study/measures/sampler.h"
#include "study/reader/study_reader.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// An echo that its paths spread over several cells of the matched filter.
namespace asdic::detail::study {
namespace {

constexpr double range = 3000.0, depth = 100.0, speed = 1500.0;  // [m], [m/s]
constexpr double source_level = 200.0, noise_level = 52.0, strength = 10.0, probability = 1e-3;
constexpr double phones = 2.0, energy = 0.375 * 0.1;  // energy of a Hann window of 0.1 s [s]

/// Lengths of the direct path and of the path reflected by the surface [m].
struct Legs {
  explicit Legs(double target)
      : direct(std::hypot(range, target - depth)), surface(std::hypot(range, target + depth)) {}
  double direct, surface;
};

class EchoWindow : public testing::Test {
 protected:
  Study read(const std::string& measure, std::vector<std::string> overrides = {}) {
    const std::vector<std::string> first{
        "pulse={ kind = \"lfm\", start_frequency = 700.0, end_frequency = 1300.0, duration = 0.1, "
        "window = \"hann\" }",
        "propagation.max_surface_bounces=1",
        "environment.wind_speed=0.0",
        "environment.surface.roughness=0.0",
        "environment.absorption={ kind = \"none\" }",
        "noise.spectral_level_db=" + std::to_string(noise_level),
        "target.0.fluctuation=\"swerling-2\""};
    overrides.insert(overrides.begin(), first.begin(), first.end());
    return read_study(folder_.write("study.toml", "[study]\nrealisations = 100000\n[measure]\n" +
                                                      measure + support::plain_sea),
                      overrides);
  }
  /// Depth of the target at which the path by the surface is three cells longer, so that the pairs
  /// of paths arrive 0, 3, 3 and 6 cells late [m].
  double depth_of_three_cells() {
    const Study study = read("snr_matched = true\n");
    const PingSimulator simulator(example_of(study));
    const double rate = recording_of(simulator.scenario()).sample_rate;
    const double cell = std::ceil(rate / noise_bandwidth(simulator.pulse(0))) / rate;
    double low = 0.0, high = 900.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      const Legs legs(middle);
      (legs.surface - legs.direct < 3.0 * cell * speed ? low : high) = middle;
    }
    return high;
  }
  static std::string at_depth(double z) {
    return "target.0.position=[" + std::to_string(range) + ", 0.0, " + std::to_string(z) + "]";
  }
  /// Shares of rows with a false alarm, and with a detection in the echo's cells.
  std::pair<double, double> rates(const Study& study, int rows) {
    const Realiser realiser(study);
    const std::vector<Column> all = columns(study);
    double alarms = 0.0, hits = 0.0;
    for (int i = 0; i < rows; ++i) {
      const Row row = realiser.realise(static_cast<std::uint64_t>(i));
      for (std::size_t c = 0; c < all.size(); ++c) {
        if (all[c].name == "false_alarm") alarms += row.values[c];
        if (all[c].name == "detected") hits += row.values[c];
      }
    }
    return {alarms / rows, hits / rows};
  }
  support::TemporaryDirectory folder_;
};

const std::string detection =
    "detection = { false_alarm_probability = 1e-3 }\nmatched_filter = { background = \"noise\" }\n";

// By images, the two pairs of one path with and one without a bounce arrive together and add up to
// four times the power of one of them. The whole echo follows one exponential g. With the SNR S_k
// of cell k in white noise, independent cells and x = −ln(1 − (1 − P)^{1/3}),
//
//   P_d = 1 − ∫ e^{−g} Π_k (1 − Q₁(√(2gS_k), √(2x))) dg
//
// Side lobes of a Hann sweep three cells away are below 3 % of the amplitude, which changes the
// weaker cells by 0.26 dB and P_d by 0.02. The count of rows may differ by 4.9 binomial standard
// deviations (10⁻⁶).
TEST_F(EchoWindow, LoudestCellOfAFluctuatingEchoIsDetectedAsByTheClosedForm) {
  const double target = depth_of_three_cells();
  const Legs legs(target);
  const double a = 1.0 / legs.direct, b = 1.0 / legs.surface;
  const double pressure = power_from_db(source_level + strength - noise_level) * phones * energy;
  const double snr[] = {pressure * std::pow(a * a, 2.0), pressure * std::pow(2.0 * a * b, 2.0),
                        pressure * std::pow(b * b, 2.0)};
  const double cell = -std::expm1(std::log1p(-probability) / 3.0);
  const auto any = [&](double g) {
    double none = 1.0;
    for (const double s : snr) none *= 1.0 - detection_probability(g * s, cell, infinity);
    return 1.0 - none;
  };
  double expected = 0.0;
  constexpr double step = 0.005;
  for (double g = 0.5 * step; g < 20.0; g += step) expected += step * std::exp(-g) * any(g);
  const Study study = read(detection, {at_depth(target)});
  constexpr int rows = 1200;
  const auto [alarms, hits] = rates(study, rows);
  EXPECT_NEAR(hits, expected, 4.9 * std::sqrt(expected * (1.0 - expected) / rows) + 0.02);
  // Probability in the strongest pair's cell alone, at the same probability of a false alarm.
  const double alone = std::pow(probability, 1.0 / (1.0 + snr[0]));
  EXPECT_GT(expected, alone + 0.2);
  EXPECT_LT(alarms, 0.01);
}

// The set probability is that of all cells together, counted in the echo's own cells for a target
// without strength, and at a time without an echo. Bounces off both boundaries make some ten cells.
// The tolerance is 4.9 binomial standard deviations of 400 rows; the correlation of cells changes
// the rate by at most P²/2.
TEST_F(EchoWindow, FalseAlarmsAreOfAllCellsTogether) {
  constexpr int rows = 400;
  constexpr double set = 0.2;
  const double room = 4.9 * std::sqrt(set * (1.0 - set) / rows);
  for (const char* background : {"noise", "expected", "around", "trend"}) {
    const std::string draws = background[0] == 'e' ? ", draws = 6" : "";
    const Study study = read(
        "detection = { false_alarm_probability = 0.2 }\nmatched_filter = { "
        "background = \"" +
            std::string(background) + "\"" + draws + " }\n",
        {"propagation.max_bottom_bounces=1", "environment.bottom.depth=400.0",
         "target.0.strength_db=-200.0"});
    const PingSimulator simulator(example_of(study));
    EXPECT_GE(cells_of_echo(simulator, simulator.levels(1), 0, 0), 6);
    const auto [alarms, hits] = rates(study, rows);
    EXPECT_NEAR(alarms, set, room + 0.5 * set * set) << background;
    EXPECT_NEAR(hits, set, room + 0.5 * set * set) << background;
  }
}

// An echo of one path has one cell, and its measures are unchanged.
TEST_F(EchoWindow, OnePathIsOneCell) {
  const Study study = read(detection, {"propagation.max_surface_bounces=0"});
  const PingSimulator simulator(example_of(study));
  EXPECT_EQ(cells_of_echo(simulator, simulator.levels(1), 0, 0), 1);
}

}  // namespace
}  // namespace asdic::detail::study
