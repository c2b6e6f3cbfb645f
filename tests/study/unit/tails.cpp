#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/random.h"
#include "study/measures/cell_counts.h"
#include "study/summary/k_shape.h"
#include "study/summary/summary_parts.h"
#include "study/summary/tail.h"
#include "support/gamma_draw.h"

namespace asdic::detail::study {
namespace {

using support::gamma_draw;

constexpr double no_end = std::numeric_limits<double>::infinity();

/// Power of a cell of K-distributed amplitude: an exponential of a gamma mean; ∞: Rayleigh.
double k_draw(double shape, RandomStream& random) {
  const double e = -std::log(random.uniform());
  return std::isinf(shape) ? e : e * gamma_draw(shape, random);
}

/// P(K power ≥ t) by Simpson's rule over its mean.
double k_survival(double t, double shape) {
  if (std::isinf(shape)) return std::exp(-t);
  double sum = 0.0;
  constexpr int n = 20000;
  constexpr double low = -40.0, high = 5.0;
  for (int i = 0; i <= n; ++i) {
    const double s = low + (high - low) * i / n, weight = i == 0 || i == n ? 1.0
                                                          : i % 2          ? 4.0
                                                                           : 2.0;
    sum += weight * std::exp(-t * std::exp(-s) + shape * (std::log(shape) + s - std::exp(s)) -
                             std::lgamma(shape));
  }
  return sum * (high - low) / n / 3.0;
}

// In closed form for ν = 1/2, whose Bessel function of order 1/2 is elementary:
// P = e^(−2√(νt)) = e^(−√(2t)).
TEST(KShape, ExceedanceIsItsClosedForms) {
  for (const double t : {0.1, 1.0, 5.0, 40.0}) {
    EXPECT_NEAR(k_exceedance(t, 0.5, no_end) / std::exp(-std::sqrt(2.0 * t)), 1.0, 1e-4) << t;
    EXPECT_NEAR(k_exceedance(t, 3.0, no_end) / k_survival(t, 3.0), 1.0, 1e-6) << t;
    EXPECT_NEAR(k_exceedance(t, 1e6, 24.0) / std::exp(-t), 1.0, 2e-4 * (1.0 + t * t)) << t;
  }
}

/// Sums of rows of so many cells, by their levels over a known mean or over that of 24 around; all
/// cells of a row share a gamma factor of that shape if `shared`.
CellSums rows_of_cells(double shape, int rows, int cells, bool around, double shared,
                       std::uint64_t seed) {
  const std::vector<double> levels = cell_levels(1e-2);
  CellSums sums = cell_sums({.targets = 1, .edges = {0.0, 1.0}, .levels = levels});
  RandomStream random(seed, Draw::study_noise, 3, 0);
  std::vector<double> power(static_cast<std::size_t>(cells));
  for (int row = 0; row < rows; ++row) {
    const double common = shared > 0.0 ? gamma_draw(shared, random) : 1.0;
    for (double& x : power) x = common * k_draw(shape, random);
    std::vector<std::uint32_t> counts(levels.size(), 0);
    for (int i = 0; i < cells; ++i) {
      double u = power[static_cast<std::size_t>(i)];
      if (around) {
        double sum = 0.0;
        for (int k = 3; k < 15; ++k)
          sum += power[static_cast<std::size_t>((i + k) % cells)] +
                 power[static_cast<std::size_t>((i - k + cells) % cells)];
        u = 24.0 * std::log1p(u / sum);
      }
      ++counts[static_cast<std::size_t>(std::upper_bound(levels.begin(), levels.end(), u) -
                                        levels.begin()) -
               1];
    }
    sums.add(packed_counts(counts));
  }
  return sums;
}

std::vector<double> counts_of(const CellSums& sums) {  // all times together
  const auto n = static_cast<std::ptrdiff_t>(sums.shape.levels.size());
  return {sums.count.begin(), sums.count.begin() + n};
}

TEST(CellCounts, PackAndAddInAnyOrder) {
  std::vector<std::uint32_t> counts(2 * 3 * 50, 0);
  counts[0] = 7;
  counts[49] = 300;
  counts[120] = 1;
  counts[299] = 70000;
  EXPECT_EQ(unpacked_counts(packed_counts(counts), counts.size()), counts);
  EXPECT_LT(packed_counts(counts).size(), 16U);
  const CellSums a = rows_of_cells(no_end, 20, 50, true, 0.0, 1),
                 b = rows_of_cells(2.0, 30, 50, true, 0.0, 2);
  CellSums one = a, other = b;
  one.add(b);
  other.add(a);
  EXPECT_EQ(one.count, other.count);
  EXPECT_EQ(one.squares, other.squares);
  EXPECT_EQ(one.realisations[0], 50);
  const CellSums again = cell_sums_of(bytes_of(one));
  EXPECT_EQ(again.count, one.count);
  EXPECT_EQ(again.with_all, one.with_all);
  EXPECT_EQ(again.shape, one.shape);
}

// The set probability is a level itself, and every power of ten is.
TEST(CellCounts, LevelsAreRoundProbabilities) {
  for (const double p : {1e-4, 0.1, 0.03, 2e-7}) {
    const std::vector<double> levels = cell_levels(p);
    EXPECT_EQ(std::count(levels.begin(), levels.end(), -std::log(p)), 1) << p;
    EXPECT_TRUE(std::is_sorted(levels.begin(), levels.end()));
    EXPECT_NEAR(*std::lower_bound(levels.begin(), levels.end(), 6.0 * std::log(10.0) - 1e-6),
                6.0 * std::log(10.0), 1e-12);
  }
}

/// How often intervals of 95 % hold the truth, of 30 sets of rows.
struct Coverage {
  int rate = 0, tail = 0, shape = 0, all = 0;
  double highest = 0.0;  // end of the tail's intervals
};
Coverage coverage(double shape, double truth_of_tail, bool around, double far) {
  Coverage made;
  for (std::uint64_t set = 0; set < 30; ++set) {
    const CellSums sums = rows_of_cells(shape, 100, 100, around, 0.0, 100 + set);
    const std::vector<double> counts = counts_of(sums), one(counts.size(), 1.0);
    ++made.all;
    const ShapeFit fit = fit_k_shape(sums.shape.levels, counts, around ? 24.0 : no_end, 1.0, 0.95);
    made.shape += fit.low <= shape && shape <= fit.high;
    const Tail tail = fit_tail(sums.shape.levels, counts, one, 0.95, false);
    const Interval at = tail.interval(far);
    made.tail += at.low <= truth_of_tail && truth_of_tail <= at.high;
    made.highest = std::max(made.highest, at.high);
  }
  return made;
}

// 30 sets of 10⁴ cells, 95 %: fewer than 21 has a probability of 10⁻⁶. At 10⁻⁶, a hundredth of
// what these sets can count.
TEST(Tails, CoverRatesThatNobodyCouldCount) {
  const double far = 6.0 * std::log(10.0);
  for (const bool around : {false, true}) {
    const Coverage rayleigh = coverage(no_end, 1e-6, around, far);
    EXPECT_GE(rayleigh.tail, 21) << around;
    EXPECT_GE(rayleigh.shape, 21) << around;
    EXPECT_LT(rayleigh.highest, 1e-3);
  }
  const Coverage spiky = coverage(2.0, k_survival(10.0, 2.0), false, 10.0);
  EXPECT_GE(spiky.tail, 21);
  EXPECT_GE(spiky.shape, 21);
  // An exponential tail, as of Rayleigh noise, holds it in none of them.
  EXPECT_GT(k_survival(10.0, 2.0), 20.0 * std::exp(-10.0));
}

// What is no such law is told: levels that end, as of a limiter, have next to no goodness.
TEST(Tails, GoodnessTellsAnotherLaw) {
  const std::vector<double> levels = cell_levels(1e-2);
  std::vector<double> counts(levels.size(), 0.0), one(levels.size(), 1.0);
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    counts[i] = std::round(1e5 * (std::exp(-levels[i]) - std::exp(-levels[i + 1])));
  EXPECT_GT(fit_tail(levels, counts, one, 0.95).goodness, 0.05);
  EXPECT_NEAR(fit_tail(levels, counts, one, 0.95).shape, 0.0, 0.02);
  EXPECT_NEAR(fit_tail(levels, counts, one, 0.95).scale, 1.0, 0.02);
  // A second kind of cell, a hundredth of them, six levels higher.
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (levels[i] > 8.0 && levels[i] < 9.5) counts[i] += 150.0;
  EXPECT_LE(fit_tail(levels, counts, one, 0.95).goodness, 0.02);
}

// All cells over the threshold in one level: any small scale is as likely, and the fit ends.
TEST(Tails, OneLevelAloneHasAnEnd) {
  const std::vector<double> levels = cell_levels(1e-2);
  std::vector<double> counts(levels.size(), 0.0), one(levels.size(), 1.0);
  counts[0] = 1e5;
  counts[20] = 100.0;
  const Tail tail = fit_tail(levels, counts, one, 0.95);
  EXPECT_TRUE(tail.fitted);
  EXPECT_EQ(tail.count, 100.0);
  EXPECT_LE(tail.rate(levels[30]), 1e-3);
}

/// A study with the matched filter that these rows might be of.
Study study_of() {
  Study study;
  study.measure.detection = DetectionPlan{.false_alarm_probability = 1e-2};
  study.measure.matched_filter.background = MatchedFilterPlan::Background::noise;
  return study;
}
Table table_of(CellSums sums) {
  Table table;
  table.columns = {{.name = "snr_matched_db", .unit = "dB", .meaning = "", .labels = {}}};
  table.values = {{20.0, 3.0}};
  table.index = {0, 1};
  table.valid = {1, 1};
  table.cells = std::move(sums);
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

// Rows whose cells rise and fall together: the interval of the rate must be that of rows, not of
// cells. 24 sets; of 95 % fewer than 17 has a probability of 10⁻⁵; taken for independent, some half
// cover.
TEST(CellRates, IntervalsKnowThatCellsOfARowAreOne) {
  constexpr double shared = 20.0;
  // E e^(−u/g) of a gamma g: the rate over a threshold −ln 10⁻².
  const double truth = k_survival(-std::log(1e-2), shared);
  const Study study = study_of();
  int covered = 0, naively = 0;
  for (std::uint64_t set = 0; set < 24; ++set) {
    const std::vector<SummaryTable> tables =
        cell_tables(study, table_of(rows_of_cells(no_end, 60, 400, false, shared, 900 + set)));
    const double rate = cell(tables, "cells_by_time", "pfa", 0);
    covered += cell(tables, "cells_by_time", "pfa_low", 0) <= truth &&
               truth <= cell(tables, "cells_by_time", "pfa_high", 0);
    naively += std::abs(rate - truth) < 1.96 * std::sqrt(rate / (60.0 * 400.0));
    EXPECT_LT(cell(tables, "cells_by_time", "worth", 0), cell(tables, "cells_by_time", "cells", 0));
  }
  EXPECT_GE(covered, 17);
  EXPECT_LT(naively, 17);
}

TEST(CellRates, WarningsSayWhichBin) {
  Study study = study_of();
  const std::vector<SummaryTable> fine =
      cell_tables(study, table_of(rows_of_cells(no_end, 100, 400, false, 0.0, 1)));
  EXPECT_TRUE(rate_warnings(study, fine).empty());
  const std::vector<SummaryTable> spiky =
      cell_tables(study, table_of(rows_of_cells(1.0, 100, 400, false, 0.0, 1)));
  const std::vector<std::string> told = rate_warnings(study, spiky);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_NE(told[0].find("cells_by_time, time 0 to 1 s: found 0.0"), std::string::npos) << told[0];
  EXPECT_NE(told[0].find("expected 0.01 within a factor of 1.3"), std::string::npos) << told[0];
  EXPECT_NE(told[1].find("background = \"expected\""), std::string::npos);
}

}  // namespace
}  // namespace asdic::detail::study
