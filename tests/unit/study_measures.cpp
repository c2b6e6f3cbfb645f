#include "study/measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "study/summary.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::study {
namespace {

class Measures : public testing::Test {
 protected:
  Study read(const std::string& tables, std::vector<std::string> overrides = {}) {
    return read_study(
        folder_.write("study.toml", "[study]\nrealisations = 1000\n" + tables + support::plain_sea),
        overrides);
  }
  support::TemporaryDirectory folder_;
};

double value(const Study& study, const Row& row, const std::string& name) {
  const std::vector<Column> all = columns(study);
  for (std::size_t c = 0; c < all.size(); ++c)
    if (all[c].name == name) return row.values.at(c);
  throw std::runtime_error("no column " + name);
}

// SNR = RL + 10 lg(nE) − NL, E = 3/8·0.1 s of the Hann window. At 60 dB the noise moves |y| by
// 1/√(2·10⁶): 0.006 dB, five of these; what the band leaves out is below −40 dB of the peak.
TEST_F(Measures, MatchedFilterReachesTheEnergysSnr) {
  for (const bool baseband : {true, false})
    for (const bool beam : {true, false}) {
      std::vector<std::string> overrides{"transmitter.source_level_db=240",
                                         "environment.absorption={kind=\"none\"}"};
      if (!baseband) overrides.insert(overrides.end(), {"pings.samples=pressure"});
      if (!baseband) overrides.emplace_back("pings.sample_rate=4000.0");
      const Study study = read(
          "[measure]\necho_level = true\nsnr_matched = true\n"
          "[measure.matched_filter]\nbackground = \"noise\"\n" +
              std::string(beam ? "" : "phone = 1\n"),
          overrides);
      const Row row = Realiser(study).realise(7);
      const double phones = beam ? 2.0 : 1.0;
      const double snr =
          value(study, row, "echo_level_db") + 10.0 * std::log10(phones * 0.375 * 0.1) - 40.0;
      EXPECT_NEAR(value(study, row, "snr_matched_db"), snr, 0.03) << baseband << beam;
      EXPECT_LT(value(study, row, "snr_absent_db"), 15.0);  // exponential: e^−31 beyond
    }
}

TEST_F(Measures, BothBackgroundsKeepTheFalseAlarmProbability) {
  for (const std::string background : {"noise", "around"}) {
    const Study study = read(
        "[measure]\ndetection = { false_alarm_probability = 0.1 }\nmatched_filter = { background = "
        "\"" +
        background + "\" }\n");
    const Realiser realiser(study);
    double alarms = 0.0, hits = 0.0;
    constexpr int n = 600;
    for (std::uint64_t i = 0; i < n; ++i) {
      const Row row = realiser.realise(i);
      alarms += value(study, row, "false_alarm");
      hits += value(study, row, "detected");
    }
    // Binomial, 4.9 standard deviations: 1e-6.
    EXPECT_NEAR(alarms / n, 0.1, 4.9 * std::sqrt(0.09 / n)) << background;
    EXPECT_GT(hits / n, alarms / n);
  }
}

// The echo comes at 4 s and lasts 0.1 s; a cell is 0.053 s. 0.2 s on either side hold no free cell
// behind the guard, and a record that ends before it nothing at all: that is not a miss.
TEST_F(Measures, WhatCannotBeComparedIsNotKnown) {
  const std::string tables = "[measure]\ndetection = true\nsnr_matched = true\n";
  for (const auto& [start, duration] : {std::pair{"3.8", "0.5"}, {"0.0", "3.9"}}) {
    const Study study = read(tables, {std::string("pings.recording_start=") + start,
                                      std::string("pings.recording_duration=") + duration});
    RunningEstimate estimate(study);
    const Realiser realiser(study);
    for (std::uint64_t i = 0; i < 3; ++i) {
      const Row row = realiser.realise(i);
      EXPECT_TRUE(std::isnan(value(study, row, "detected"))) << start;
      EXPECT_TRUE(std::isnan(value(study, row, "snr_matched_db"))) << start;
      estimate.add(row);
    }
    EXPECT_EQ(estimate.left_out(), 3U);
    EXPECT_FALSE(estimate.estimate().has_value());
  }
}

// 24 free cells of 1/100 Hz around a pulse of 1 s, a hundred cells long.
TEST_F(Measures, AWidePulseFindsItsFreeCellsFurtherOut) {
  const Study study =
      read("[measure]\ndetection = true\nsnr_matched = true\n",
           {"pulse={kind=\"lfm\", start_frequency=950.0, end_frequency=1050.0, duration=1.0, "
            "window=\"hann\"}",
            "transmitter.source_level_db=220"});
  const Row row = Realiser(study).realise(0);
  EXPECT_EQ(value(study, row, "detected"), 1.0);
  EXPECT_FALSE(std::isnan(value(study, row, "snr_absent_db")));
}

TEST_F(Measures, ReceiverFindsAndPlacesALoudTarget) {
  const std::string tables =
      "[measure]\ndetection = { by = \"receiver\" }\nlocalisation_error = true\n"
      "[measure.receiver]\ntarget_depth = 100.0\n";
  const Study study = read(tables, {"transmitter.source_level_db=225", "array.phones=8"});
  const Row row = Realiser(study).realise(0);
  EXPECT_EQ(value(study, row, "detected"), 1.0);
  EXPECT_EQ(value(study, row, "false_alarms"), 0.0);
  // A cell of the pulse is 0.1 s, 75 m; the interpolated peak at 40 dB lies well within it.
  EXPECT_LT(std::abs(value(study, row, "range_error")), 10.0);
  const Study quiet = read(tables, {"transmitter.source_level_db=150"});
  const Row missed = Realiser(quiet).realise(0);
  EXPECT_EQ(value(quiet, missed, "detected"), 0.0);
  EXPECT_TRUE(std::isnan(value(quiet, missed, "position_error")));
}

TEST_F(Measures, KeepsTheTimeSeriesOfEveryKth) {
  const Study study = read("[measure]\nseries_level = true\ntime_series = 3\n");
  const Realiser realiser(study);
  EXPECT_TRUE(realiser.realise(1).pressure.empty());
  const Row row = realiser.realise(3);
  ASSERT_EQ(row.pressure_shape.size(), 3U);
  EXPECT_EQ(row.pressure_shape[0], 2U);
  EXPECT_EQ(row.pressure_shape[2], 2U);
  EXPECT_EQ(row.pressure.size(), row.pressure_shape[0] * row.pressure_shape[1] * 2);
  double sum = 0.0;
  for (const float p : row.pressure) sum += double(p) * double(p);
  const double rms = 10.0 * std::log10(0.5 * sum / (double(row.pressure.size()) / 2.0) * 1e12);
  EXPECT_NEAR(value(study, row, "series_rms_db"), rms, 1e-6);
}

TEST_F(Measures, CheapOnesAreTheSameBesideDearOnes) {
  const std::string levels =
      "[measure]\necho_level = true\nreverberation_level = true\nnoise_level = true\n"
      "signal_excess = true\npaths = true\necho_time = true\nstrongest_path = true\n";
  const Study cheap = read(levels), dear = read(levels + "series_level = true\n");
  const Row a = Realiser(cheap).realise(5), b = Realiser(dear).realise(5);
  ASSERT_EQ(a.values.size() + 2, b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i)
    EXPECT_TRUE(a.values[i] == b.values[i] || (std::isnan(a.values[i]) && std::isnan(b.values[i])))
        << i;
}

TEST_F(Measures, ColumnsOfSeveralTargetsBearTheirNames) {
  const Study study =
      read("[measure]\necho_level = true\ndetection = true\n",
           {"target=[{name=\"U-boat 7\", position=[3000.0,0.0,100.0], strength_db=10.0}, "
            "{name=\"whale\", position=[2000.0,0.0,100.0], strength_db=0.0}]"});
  const std::vector<Column> all = columns(study);
  EXPECT_EQ(all[0].name, "echo_level_db_u_boat_7");
  EXPECT_EQ(all[1].name, "detected_u_boat_7");
  EXPECT_EQ(all[5].name, "echo_level_db_whale");
}

}  // namespace
}  // namespace asdic::study
