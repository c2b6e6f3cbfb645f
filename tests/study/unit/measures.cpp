#include "study/measures/measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "io/scenario/scenario_reader.h"
#include "study/measures/echo_filter.h"
#include "study/reader/study_reader.h"
#include "study/summary/summary.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
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

/// The part of a whole record that a study would have made.
PingRecord cut(const PingRecord& whole, const SampleRange& part) {
  PingRecord record = whole;
  const Recording& r = whole.recording;
  record.recording.start += static_cast<double>(part.first) / r.sample_rate;
  record.recording.samples = part.count;
  record.pressure.clear();
  for (std::size_t n = 0; n < whole.phones.size(); ++n) {
    const auto first = whole.pressure.begin() +
                       static_cast<std::ptrdiff_t>(n * r.samples * r.components()) +
                       part.first * static_cast<std::ptrdiff_t>(r.components());
    record.pressure.insert(record.pressure.end(), first,
                           first + static_cast<std::ptrdiff_t>(part.count * r.components()));
  }
  return record;
}

// What is made of a record is all that its matched filters look at: in the same samples without the
// rest they say the same, near the record's ends as well, for a narrow and for a wide pulse.
TEST_F(Measures, FiltersLookAtNoMoreThanIsMade) {
  const std::string lfm =
      "pulse={kind=\"lfm\", start_frequency=950.0, end_frequency=1050.0, duration=0.3}";
  for (const std::string pulse : {"pulse.duration=0.1", lfm.c_str()})
    for (const std::string range : {"target.0.range=200.0", "target.0.range=3000.0",
                                    "target.0.range=5700.0", "target.0.range=6100.0"})
      for (const std::string samples : {"baseband", "pressure"}) {
        std::vector<std::string> overrides{pulse, "pings.samples=" + samples, range,
                                           "target.0.bearing_deg=30.0"};
        std::string sea = support::plain_sea;
        sea.replace(sea.find("position = [3000.0, 0.0, 100.0]"), 31,
                    "range = 3000.0\nbearing_deg = 0.0\ndepth = 100.0");
        if (samples == "pressure") overrides.emplace_back("pings.sample_rate=4000.0");
        const PingSimulator simulator(read_scenario(folder_.write("sea.toml", sea), overrides));
        const PingRecord whole = simulator.simulate(1);
        for (const auto background :
             {MatchedFilterPlan::Background::around, MatchedFilterPlan::Background::noise}) {
          const MatchedFilterPlan plan{.background = background};
          const SampleRange part = samples_for_filter(simulator, whole, plan, 0);
          ASSERT_GE(part.first, 0);
          ASSERT_LE(static_cast<std::size_t>(part.first) + part.count, whole.recording.samples);
          EXPECT_LT(part.count, whole.recording.samples);
          const FilterAnswer all = filter_answer(simulator, whole, plan, 0, 0, 1e-3),
                             some = filter_answer(simulator, cut(whole, part), plan, 0, 0, 1e-3);
          const auto same = [](double a, double b) {
            return a == b || (std::isnan(a) && std::isnan(b));
          };
          EXPECT_TRUE(same(all.present, some.present)) << pulse << range << samples;
          EXPECT_TRUE(same(all.absent, some.absent)) << pulse << range << samples;
          EXPECT_FALSE(std::isnan(all.absent)) << pulse << range << samples;
        }
      }
}

// A part that is made by itself holds the echo that the whole record has there: noise of −60 dB is
// 10⁻⁷ of it, and samples are right to −80 dB.
TEST_F(Measures, APartOfARecordHoldsItsEcho) {
  const PingSimulator simulator(
      read_scenario(folder_.write("sea.toml", support::plain_sea),
                    std::vector<std::string>{"noise.spectral_level_db=-60.0"}));
  const PingRecord whole = simulator.simulate(1);
  const SampleRange part{.first = std::ptrdiff_t(whole.recording.samples) / 2 - 7, .count = 300};
  const PingRecord made = simulator.simulate(1, [&](const PingRecord&) { return part; });
  const PingRecord expected = cut(whole, part);
  ASSERT_EQ(made.pressure.size(), expected.pressure.size());
  double loudest = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < made.pressure.size(); ++i) {
    loudest = std::max(loudest, std::abs(double(expected.pressure[i])));
    difference = std::max(difference, std::abs(double(made.pressure[i] - expected.pressure[i])));
  }
  EXPECT_GT(loudest, 0.0);
  EXPECT_LT(difference, 2e-4 * loudest);
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
  const std::string tables =
      "[measure]\ndetection = true\nsnr_matched = true\n"
      "matched_filter = { background = \"around\" }\n";
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
  const Study study = read(
      "[measure]\ndetection = true\nsnr_matched = true\n"
      "matched_filter = { background = \"around\" }\n",
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

// The table is the description that `asdic process` has its options of: all settings, one range.
TEST_F(Measures, TheReceiverTakesWhatProcessTakes) {
  const ProcessingSettings made =
      read(
          "[measure]\nlocalisation_error = true\n[measure.receiver]\nbeamformer = \"mvdr\"\n"
          "mvdr_loading_db = -3.0\nshading = \"hann\"\nelevations = \"-20:20\"\n"
          "max_speed = 600.0\nnormaliser = \"cell-averaging\"\nacross_beams = false\n"
          "guard_cells = 1e5\nreference_cells = 1e5\nfalse_alarm_probability = 1e-20\n"
          "from = 1.0\nuntil = 2e6\ntarget_depth = 90.0\nrange_speed = 1490.0\n")
          .measure.receiver;
  EXPECT_EQ(made.detector.beamformer, Beamformer::mvdr);
  EXPECT_EQ(made.detector.mvdr.loading_db, -3.0);
  EXPECT_EQ(made.detector.shading, Shading::hann);
  EXPECT_EQ(made.detector.lowest_elevation, radians(-20.0));
  EXPECT_EQ(made.detector.highest_elevation, radians(20.0));
  EXPECT_EQ(made.max_speed, 600.0);
  EXPECT_EQ(made.detector.normaliser.method, Normaliser::cell_averaging);
  EXPECT_FALSE(made.detector.normaliser.across_beams);
  EXPECT_EQ(made.detector.normaliser.guard_cells, 1e5);
  EXPECT_EQ(made.detector.normaliser.reference_cells, 1e5);
  EXPECT_EQ(made.detector.normaliser.false_alarm_probability, 1e-20);
  EXPECT_EQ(made.detector.first_time, 1.0);
  EXPECT_EQ(made.detector.last_time, 2e6);
  EXPECT_EQ(made.target_depth, 90.0);
  EXPECT_EQ(made.range_speed, 1490.0);
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
}  // namespace asdic::detail::study
