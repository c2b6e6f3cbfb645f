#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "core/units.h"
#include "study/reader/study_reader.h"
#include "study/summary/summary.h"

namespace asdic::detail::study {
namespace {

Table rows_of(const Study& study) {
  const Realiser realiser(study);
  std::vector<Row> rows(study.realisations);
  tbb::parallel_for(std::size_t{0}, rows.size(),
                    [&](std::size_t i) { rows[i] = realiser.realise(i); });
  Table table{.columns = columns(study)};
  table.values.resize(table.columns.size());
  for (const Row& row : rows) {
    table.index.push_back(row.index);
    table.valid.push_back(row.valid);
    for (std::size_t c = 0; c < row.values.size(); ++c) table.values[c].push_back(row.values[c]);
  }
  return table;
}

const SummaryTable& named(const std::vector<SummaryTable>& tables, const std::string& name) {
  for (const SummaryTable& table : tables)
    if (table.name == name) return table;
  throw std::runtime_error("no table " + name);
}

double value(const SummaryTable& table, const std::string& column, std::size_t row) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == column) return table.values[c].at(row);
  throw std::runtime_error("no column " + column);
}

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
  const std::vector<SummaryTable> summary = summarise(study, rows_of(study));
  // Over all ranges, within the study's own 99 % interval.
  const SummaryTable& all = named(summary, "convergence");
  const std::size_t last = all.values[0].size() - 1;
  const double truth = closed_form(20e3, 40e3);
  EXPECT_LT(value(all, "pd_low", last), truth);
  EXPECT_GT(value(all, "pd_high", last), truth);
  // And in every bin of range.
  const SummaryTable& by_range = named(summary, "pd_by_range");
  ASSERT_EQ(by_range.values[0].size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    const double pd =
        closed_form(value(by_range, "range_low", i), value(by_range, "range_high", i));
    EXPECT_LT(value(by_range, "pd_low", i), pd) << i;
    EXPECT_GT(value(by_range, "pd_high", i), pd) << i;
  }
  // False alarms: 1500 chances of 1e-4; more than 5 have a probability of 1e-8.
  const SummaryTable& statistics = named(summary, "statistics");
  for (std::size_t i = 0; i < statistics.values[0].size(); ++i) {
    const bool alarms = statistics.columns[0].labels[i] == "false_alarm";
    if (alarms) {
      EXPECT_LE(value(statistics, "mean", i) * 1500.0, 5.0);
    }
  }
}

TEST(KnownAnswer, ATargetThatDoesNotFluctuateIsAnother) {
  // The wrong model must fail: four degrees of freedom instead of two.
  const Study study = read_study(
      file, std::vector<std::string>{"target.0.fluctuation=swerling-3", "study.realisations=4000"});
  const std::vector<SummaryTable> summary = summarise(study, rows_of(study));
  const SummaryTable& by_range = named(summary, "pd_by_range");
  int outside = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const double pd =
        closed_form(value(by_range, "range_low", i), value(by_range, "range_high", i));
    outside += !(value(by_range, "pd_low", i) < pd && pd < value(by_range, "pd_high", i));
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
    const Table around = rows_of(with_lfm(product, "around", n));
    const Table known = rows_of(with_lfm(product, "noise", n));
    const double pd = mean_of(around, "detected"), best = mean_of(known, "detected");
    EXPECT_NEAR(best - pd, loss, 4.9 * std::sqrt(0.2 / n) + 0.002) << product;
    // One share against its closed form: √(p(1 − p)/n) ≤ 0.025.
    EXPECT_NEAR(pd, with_estimated_background(20e3, 40e3), 4.9 * 0.025) << product;
    EXPECT_NEAR(best, closed_form(20e3, 40e3), 4.9 * 0.025) << product;
  }
}

}  // namespace
}  // namespace asdic::detail::study
