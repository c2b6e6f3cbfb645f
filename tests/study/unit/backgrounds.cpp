#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "io/scenario/scenario_reader.h"
#include "study/measures/echo_filter.h"
#include "study/measures/measures.h"
#include "study/reader/study_reader.h"
#include "study/summary/summary.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

std::size_t place(const Study& study, const std::string& name) {
  const std::vector<Column> all = columns(study);
  for (std::size_t c = 0; c < all.size(); ++c)
    if (all[c].name == name) return c;
  throw std::runtime_error("no column " + name);
}

/// A sea whose bottom answers from 1.2 s on, when it lies 900 m below: a cliff, then a slope of up
/// to 60 dB a second at 1.33 s; the echo comes in the midst of it.
class Backgrounds : public testing::Test {
 protected:
  Study read(const std::string& tables, std::vector<std::string> overrides = {}) {
    const std::vector<std::string> first{
        "reverberation={ bottom = { kind = \"lambert\", mu_db = -27.0 } }",
        "propagation.max_bottom_bounces=1", "pings.recording_duration=5.0",
        "target.0.position=[1000.0, 0.0, 100.0]"};
    overrides.insert(overrides.begin(), first.begin(), first.end());
    return read_study(
        folder_.write("study.toml", "[study]\nrealisations = 1000\n" + tables + support::plain_sea),
        overrides);
  }
  /// The share of false alarms, and of detections.
  std::pair<double, double> rates(const Study& study, int rows) {
    const Realiser realiser(study);
    const std::size_t alarm = place(study, "false_alarm"), hit = place(study, "detected");
    double alarms = 0.0, hits = 0.0;
    for (int i = 0; i < rows; ++i) {
      const Row row = realiser.realise(static_cast<std::uint64_t>(i));
      alarms += row.values.at(alarm);
      hits += row.values.at(hit);
    }
    return {alarms / rows, hits / rows};
  }
  support::TemporaryDirectory folder_;
};

std::string detection(const std::string& background) {
  return "[measure]\ndetection = { false_alarm_probability = 0.1 }\nmatched_filter = { background "
         "= \"" +
         background + "\" }\n";
}

// Binomial of 120 rows, 4.9 standard deviations: 10⁻⁶; four draws are enough for (3). The target's
// strength is none, so that what is detected at the echo's time is a false alarm as well.
TEST_F(Backgrounds, WhatIsExpectedKeepsTheRateOnACliff) {
  constexpr int rows = 120;
  const double room = 4.9 * std::sqrt(0.09 / rows);
  const std::vector<std::string> silent{"target.0.strength_db=-200.0"};
  const std::string expected =
      "[measure]\ndetection = { false_alarm_probability = 0.1 }\n"
      "matched_filter = { background = \"expected\", draws = 4 }\n";
  const auto [alarms, hits] = rates(read(expected, silent), rows);
  EXPECT_NEAR(alarms, 0.1, room);
  EXPECT_NEAR(hits, 0.1, room);
  // Cells around the echo compare a place below the cliff with the ground above it, and the other
  // way round.
  const auto [by_mean, of_mean] = rates(read(detection("around"), silent), rows);
  EXPECT_LT(by_mean, 0.02);
  EXPECT_GT(of_mean, 0.9);
}

// What is taken where nothing is said; whoever tells cells wants cells.
TEST_F(Backgrounds, TheExpectedOneIsTaken) {
  using Background = MatchedFilterPlan::Background;
  const auto background = [&](const std::string& filter) {
    return read("[measure]\nsnr_matched = true\n" + filter).measure.matched_filter.background;
  };
  EXPECT_EQ(background(""), Background::expected);
  EXPECT_EQ(background("matched_filter = { reference_cells = 8 }\n"), Background::around);
  const Study left_out = read("[measure]\nsnr_matched = true\n"),
              around = read("[measure]\nsnr_matched = true\n",
                            {"measure.matched_filter.background=around"});
  EXPECT_NE(identity(left_out), identity(around));
}

TEST_F(Backgrounds, ATrendKeepsTheRateInEvenNoise) {
  constexpr int rows = 300;
  const Study study = read(detection("trend"), {"reverberation.enabled=false"});
  const auto [alarms, hits] = rates(study, rows);
  EXPECT_NEAR(alarms, 0.1, 4.9 * std::sqrt(0.09 / rows));
  EXPECT_GT(hits, 0.5);
}

// Every answer by the transform is the sum in time, at real pressure and baseband, of two phones.
TEST_F(Backgrounds, AllCellsAnswerAsOneByOne) {
  for (const char* samples : {"baseband", "pressure"}) {
    const Scenario scenario = read_scenario(
        folder_.write("sea.toml", support::plain_sea),
        samples[0] == 'b'
            ? std::vector<std::string>{"pings.samples=baseband"}
            : std::vector<std::string>{"pings.samples=pressure", "pings.sample_rate=4000.0"});
    const PingSimulator simulator(scenario);
    const PingRecord record = simulator.simulate(1);
    const Pulse& pulse = simulator.pulse(0);
    const MatchedFilterAt filter(record.recording, pulse, 1.0001, {{0, 2.0}, {1, 2.00071}});
    const std::vector<double> all =
        filter.answers(record.pressure, record.recording.samples, 0, -90, 7, 60);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double one = filter.answer(record.pressure, record.recording.samples, 0,
                                       -90 + 7 * static_cast<std::ptrdiff_t>(i));
      EXPECT_NEAR(all[i], one, 1e-9 * one + 1e-20) << samples << i;
    }
  }
}

TEST_F(Backgrounds, MessagesOfTheirKeys) {
  const auto message = [&](const std::string& tables) {
    try {
      read(tables);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message("[measure]\nsnr_matched = true\nmatched_filter = { background = "
                    "\"trend\", draws = 8 }\n")
                .find("background = \"expected\""),
            std::string::npos);
  EXPECT_NE(message("[measure]\necho_level = true\ncells = true\n").find("matched filter"),
            std::string::npos);
  EXPECT_NE(message("[measure]\nsnr_matched = true\ncells = { edges = [2.0, 1.0] }\n").find("rise"),
            std::string::npos);
  EXPECT_NE(message("[measure]\nsnr_matched = true\ncells = { edges = [1.0, 2.0], bins = 3 }\n")
                .find("both"),
            std::string::npos);
}

/// Rows of a study with cells, summed.
Table rows_of(const Study& study, std::uint64_t rows) {
  Table table{.columns = columns(study), .index = {}, .valid = {}, .values = {}};
  table.values.resize(table.columns.size());
  table.cells = cell_sums(cell_shape(study));
  const Realiser realiser(study);
  for (std::uint64_t i = 0; i < rows; ++i) {
    const Row row = realiser.realise(i);
    table.index.push_back(i);
    table.valid.push_back(1);
    for (std::size_t c = 0; c < row.values.size(); ++c) table.values[c].push_back(row.values[c]);
    table.cells.add(std::span<const std::uint8_t>(row.cells));
  }
  return table;
}

double cell(const std::vector<SummaryTable>& tables, const std::string& name,
            const std::string& column, std::size_t row) {
  for (const SummaryTable& table : tables)
    if (table.name == name)
      for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (table.columns[c].name == column) return table.values[c].at(row);
  throw std::runtime_error("no " + name + "/" + column);
}

// White noise is Rayleigh: of 40 rows and some 3500 cells the rate is the one that is set, within
// 4.9 of its own standard deviations; none counts that holds an echo.
TEST_F(Backgrounds, CellsOfWhiteNoiseKeepTheRate) {
  for (const char* background : {"noise", "around", "trend", "expected"}) {
    const Study study = read(
        "[measure]\ndetection = { false_alarm_probability = 0.03 }\ncells = { bins = 4 }\n"
        "matched_filter = { background = \"" +
            std::string(background) + (background[0] == 'e' ? "\", draws = 6 }\n" : "\" }\n"),
        {"reverberation.enabled=false", "target.0.strength_db=40.0"});
    const std::vector<SummaryTable> tables = summarise(study, rows_of(study, 40));
    const double cells = cell(tables, "false_alarm_rates", "worth", 1);
    EXPECT_GT(cells, 1500.0) << background;
    EXPECT_NEAR(cell(tables, "false_alarm_rates", "pfa", 1), 0.03,
                4.9 * std::sqrt(0.03 * 0.97 / cells))
        << background;
    EXPECT_NEAR(cell(tables, "false_alarm_rates", "pfa_set", 1), 0.03, 1e-12);
  }
}

}  // namespace
}  // namespace asdic::detail::study
