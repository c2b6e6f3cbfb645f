#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "study/reader/study_reader.h"
#include "study/summary/summary.h"
#include "support/realised.h"
#include "support/summary_tables.h"

namespace asdic::detail::study {
namespace {

using support::realised;

/// Pd = Pfa^(1/(1 + SNR)), SNR = RL + 10 lg E − NL with E = 3/8·0.25 s of the Hann window.
/// docs/theory/studies.md, eq. (4)
double closed_form(double range) {
  const double level = 200.0 - 40.0 * std::log10(range) + 30.0;
  const double snr = power_from_db(level - 32.0) * 0.375 * 0.25;
  return std::pow(1e-4, 1.0 / (1.0 + snr));
}

/// Mean over ranges even between two.
double closed_form(double low, double high) {
  double sum = 0.0;
  for (int i = 0; i < 2000; ++i) sum += closed_form(low + (high - low) * (i + 0.5) / 2000.0);
  return sum / 2000.0;
}

const std::filesystem::path file =
    std::filesystem::path(ASDIC_SCENARIOS) / "studies/known_answer.toml";

TEST(KnownAnswer, PdOfASwerling1TargetInWhiteNoise) {
  const Study study = read_study(file, std::vector<std::string>{"study.realisations=4000"});
  const std::vector<SummaryTable> summary = summarise(study, realised(study));
  // Over all ranges, within the study's own 99 % interval.
  const SummaryTable& all = named(summary, "convergence");
  const std::size_t last = all.values[0].size() - 1;
  const double truth = closed_form(20e3, 40e3);
  EXPECT_LT(column(all, "pd_low").at(last), truth);
  EXPECT_GT(column(all, "pd_high").at(last), truth);
  // And in every bin of range.
  const SummaryTable& by_range = named(summary, "pd_by_range");
  ASSERT_EQ(by_range.values[0].size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    const double pd =
        closed_form(column(by_range, "range_low").at(i), column(by_range, "range_high").at(i));
    EXPECT_LT(column(by_range, "pd_low").at(i), pd) << i;
    EXPECT_GT(column(by_range, "pd_high").at(i), pd) << i;
  }
  // False alarms: 1500 chances of 1e-4; more than 5 have a probability of 1e-8.
  const SummaryTable& statistics = named(summary, "statistics");
  for (std::size_t i = 0; i < statistics.values[0].size(); ++i) {
    const bool alarms = statistics.columns[0].labels[i] == "false_alarm";
    if (alarms) {
      EXPECT_LE(column(statistics, "mean").at(i) * 1500.0, 5.0);
    }
  }
}

// Rows from far out for the most part, in a map: Pd of each cell by its weights. The share of the
// rows that detect is another.
TEST(KnownAnswer, PdOfAMapByWeights) {
  const Study study = read_study(
      file, std::vector<std::string>{
                "study.realisations=2000",
                "vary.\"target.0.range\"={law=\"uniform\", low=20e3, high=40e3, "
                "proposal={law=\"normal\", mean=39e3, deviation=3e3}}",
                "vary.\"target.0.bearing_deg\"={law=\"uniform\", low=0.0, high=360.0}",
                "summary.map={cells=\"range_bearing\", range={bins=2}, bearing={bins=2}}"});
  const std::vector<SummaryTable> summary = summarise(study, realised(study));
  const SummaryTable& map = named(summary, "map_pd");
  ASSERT_EQ(map.values[0].size(), 4U);
  int outside = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double low = column(map, "pd_low")[i], high = column(map, "pd_high")[i];
    const double pd = closed_form(column(map, "range_low")[i], column(map, "range_high")[i]);
    EXPECT_LT(low, pd) << i;
    EXPECT_GT(high, pd) << i;
    EXPECT_LT(high - low, 0.3) << i;
    const double plain = column(map, "hits")[i] / column(map, "count")[i];
    outside += !(low < plain && plain < high);
  }
  EXPECT_GE(outside, 2);
}

TEST(KnownAnswer, ATargetThatDoesNotFluctuateIsAnother) {
  // The wrong model must fail: four degrees of freedom instead of two.
  const Study study = read_study(
      file, std::vector<std::string>{"target.0.fluctuation=swerling-3", "study.realisations=4000"});
  const std::vector<SummaryTable> summary = summarise(study, realised(study));
  const SummaryTable& by_range = named(summary, "pd_by_range");
  int outside = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const double pd =
        closed_form(column(by_range, "range_low").at(i), column(by_range, "range_high").at(i));
    outside += !(column(by_range, "pd_low").at(i) < pd && pd < column(by_range, "pd_high").at(i));
  }
  EXPECT_GE(outside, 2);
}

/// The known answer's sea with an LFM pulse of 0.25 s and that time-bandwidth product.
Study with_lfm(double product, const std::string& background, int realisations) {
  const double half = 0.5 * product / 0.25;
  return read_study(file,
                    std::vector<std::string>{
                        "study.realisations=" + std::to_string(realisations),
                        "pulse={kind=\"lfm\", start_frequency=" + std::to_string(1000.0 - half) +
                            ", end_frequency=" + std::to_string(1000.0 + half) +
                            ", duration=0.25, window=\"hann\"}",
                        "measure.matched_filter.background=\"" + background + "\""});
}

double mean_of(const Table& table, const std::string& name) {
  double sum = 0.0, count = 0.0;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == name)
      for (const double x : table.values[c]) sum += x, count += 1.0;
  return sum / count;
}

// The background's mean over m = 24 exponential cells instead of a known one: the statistic of a
// Swerling 1 target is (1 + SNR) times F(2, 2m), so Pd = (1 + (Pfa^(−1/m) − 1)/(1 + SNR))^−m.
// docs/theory/studies.md, eq. (5)
double with_estimated_background(double low, double high) {
  constexpr double cells = 24.0;
  double sum = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double range = low + (high - low) * (i + 0.5) / 2000.0;
    const double known = std::log(1e-4) / std::log(closed_form(range));  // 1 + SNR
    sum += std::pow(1.0 + std::expm1(-std::log(1e-4) / cells) / known, -cells);
  }
  return sum / 2000.0;
}

// However wide the pulse, Pd over the estimated background differs from that over the known one
// by its loss alone. Both are of the same pings; the difference of two shares of n rows that agree
// in all but a share d of them has a standard deviation of at most √(d/n): d < 0.2, 4.9 of these
// are a probability of 1e-6. Correlation between neighbouring cells (|ρ|² = 0.035) leaves 22 to 23
// cells' worth of 24: 0.002 of Pd.
TEST(KnownAnswer, WidePulsesLoseTheEstimatesLossAlone) {
  constexpr int n = 400;
  const double loss = closed_form(20e3, 40e3) - with_estimated_background(20e3, 40e3);
  for (const double product : {1.0, 20.0, 50.0}) {
    const Table around = realised(with_lfm(product, "around", n));
    const Table known = realised(with_lfm(product, "noise", n));
    const double pd = mean_of(around, "detected"), best = mean_of(known, "detected");
    EXPECT_NEAR(best - pd, loss, 4.9 * std::sqrt(0.2 / n) + 0.002) << product;
    // One share against its closed form: √(p(1 − p)/n) ≤ 0.025.
    EXPECT_NEAR(pd, with_estimated_background(20e3, 40e3), 4.9 * 0.025) << product;
    EXPECT_NEAR(best, closed_form(20e3, 40e3), 4.9 * 0.025) << product;
  }
}

}  // namespace
}  // namespace asdic::detail::study
