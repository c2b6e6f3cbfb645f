#include "study/summary/summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "study/sampling/design.h"
#include "study/sampling/law.h"
#include "study/summary/intervals.h"
#include "support/summary_tables.h"

namespace asdic::detail::study {
namespace {

TEST(Intervals, WilsonAndClopperPearsonOfTheBooks) {
  // No success of 10: Wilson z²/(n + z²), Clopper & Pearson 1 − 0.025^(1/10).
  EXPECT_NEAR(wilson(0, 10, 0.95).high, 3.841458820694124 / 13.841458820694124, 1e-12);
  EXPECT_EQ(wilson(0, 10, 0.95).low, 0.0);
  EXPECT_NEAR(clopper_pearson(0, 10, 0.95).high, 1.0 - std::pow(0.025, 0.1), 1e-12);
  EXPECT_EQ(clopper_pearson(10, 10, 0.95).high, 1.0);
  // Five of 10, Brown, Cai & DasGupta (2001): Wilson's closed form, and the beta quantiles.
  EXPECT_NEAR(wilson(5, 10, 0.95).low, 0.2365931, 1e-6);
  EXPECT_NEAR(clopper_pearson(5, 10, 0.95).low, 0.1870860, 1e-6);
  EXPECT_NEAR(clopper_pearson(5, 10, 0.95).high, 0.8129140, 1e-6);
}

TEST(Intervals, IncompleteBetaIsTheBinomialsTail) {
  // I_p(k, n − k + 1) = P(at least k successes of n).
  for (const int k : {1, 3, 9, 20}) {
    double tail = 0.0;
    for (int i = k; i <= 20; ++i)
      tail += std::exp(std::lgamma(21.0) - std::lgamma(i + 1.0) - std::lgamma(21.0 - i) +
                       i * std::log(0.3) + (20 - i) * std::log(0.7));
    EXPECT_NEAR(incomplete_beta(k, 21.0 - k, 0.3), tail, 1e-12) << k;
  }
}

/// How often an interval holds the truth, over all outcomes of n trials.
double coverage(ProportionInterval kind, int n, double p) {
  double sum = 0.0;
  for (int k = 0; k <= n; ++k) {
    const Interval i = proportion_interval(kind, k, n, 0.95);
    if (i.low <= p && p <= i.high)
      sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                      k * std::log(p) + (n - k) * std::log1p(-p));
  }
  return sum;
}

TEST(Intervals, CoverWhatTheyPromise) {
  for (const int n : {5, 20, 100})
    for (int i = 1; i < 40; ++i) {
      const double p = i / 40.0;
      // Clopper & Pearson never less; Wilson's dips to 0.83 near the ends (Brown et al., Fig. 5).
      EXPECT_GE(coverage(ProportionInterval::clopper_pearson, n, p), 0.95 - 1e-12) << n << ' ' << p;
      EXPECT_GE(coverage(ProportionInterval::wilson, n, p), 0.83) << n << ' ' << p;
    }
}

TEST(Statistics, RanksShareTies) {
  EXPECT_EQ(ranks(std::vector<double>{5.0, 1.0, 5.0, 7.0}), (std::vector<double>{2.5, 1, 2.5, 4}));
  EXPECT_EQ(sample_quantile(std::vector<double>{1.0, 2.0, 4.0}, 0.75), 3.0);
}

/// Rows x (uniform), y (uniform), kind (0, 1, 2) → level = 3x + y + noise, detected = x < 0.3.
Table made_up(std::size_t n) {
  Table table;
  const auto input = Column::Role::input, measure = Column::Role::measure;
  table.columns = {{.name = "x", .unit = "m", .role = input},
                   {.name = "y", .unit = "1", .role = input},
                   {.name = "kind", .unit = "1", .role = input, .labels = {"a", "b", "c"}},
                   {.name = "level_db", .unit = "dB", .role = measure},
                   {.name = "detected", .unit = "1", .role = measure},
                   {.name = "snr_matched_db", .unit = "dB", .role = measure},
                   {.name = "snr_absent_db", .unit = "dB", .role = measure}};
  table.values.resize(table.columns.size());
  for (std::size_t i = 0; i < n; ++i) {
    const auto u = [&](std::uint32_t d) { return uniform_draw(5, i, d); };
    const double x = u(0), y = u(1), noise = CutLaw(Normal{0.0, 0.5}).quantile(u(2));
    table.index.push_back(i);
    table.valid.push_back(i % 10 != 9);
    const std::vector<double> row{x, y, double(i % 3), 3.0 * x + y + noise, x < 0.3 ? 1.0 : 0.0,
                                  // Exponential with mean 4, and with mean 1.
                                  10.0 * std::log10(-4.0 * std::log(u(3))),
                                  10.0 * std::log10(-std::log(u(4)))};
    for (std::size_t c = 0; c < row.size(); ++c)
      table.values[c].push_back(table.valid[i] != 0 || c < 3 ? row[c] : std::nan(""));
  }
  return table;
}

Study asking(std::vector<std::vector<SummaryAxis>> by) {
  Study study;
  study.summary.by = std::move(by);
  return study;
}

TEST(Summary, StatisticsOfEveryColumn) {
  const auto tables = summarise(asking({}), made_up(4000));
  const SummaryTable& t = named(tables, "statistics");
  EXPECT_EQ(t.columns[0].labels[3], "level_db");
  EXPECT_EQ(column(t, "count")[3], 3600.0);
  EXPECT_NEAR(column(t, "mean")[3], 2.0, 5.0 / 60.0);  // five standard errors, σ = 1.04
  EXPECT_NEAR(column(t, "deviation")[3], std::sqrt(10.0 / 12.0 + 0.25), 0.06);
  EXPECT_LT(column(t, "mean_low")[3], column(t, "mean")[3]);
  EXPECT_NEAR(column(t, "q0500")[0], 0.5, 0.05);
}

// Two quantiles never share a name, and none bears that of another.
TEST(Summary, QuantilesBearTheirOwnNames) {
  const std::vector<std::pair<double, std::string>> names{
      {0.0, "q0000"},     {0.05, "q0050"},  {0.5, "q0500"},    {0.975, "q0975"},
      {0.9999, "q09999"}, {0.001, "q0001"}, {1e-5, "q000001"}, {1.0, "q1000"}};
  Study study = asking({});
  study.summary.quantiles.clear();
  for (const auto& [p, name] : names) study.summary.quantiles.push_back(p);
  const auto tables = summarise(study, made_up(100));
  for (const auto& [p, name] : names)
    EXPECT_NO_THROW(static_cast<void>(column(named(tables, "statistics"), name))) << p;
  EXPECT_GE(column(named(tables, "statistics"), "q1000")[0],
            column(named(tables, "statistics"), "q09999")[0]);
}

TEST(Summary, ProportionsFallIntoTheirBins) {
  const auto tables =
      summarise(asking({{{.column = "x", .edges = {0.0, 0.3, 0.5, 1.0}}}}), made_up(1000));
  const SummaryTable& t = named(tables, "pd_by_x");
  EXPECT_EQ(column(t, "pd"), (std::vector<double>{1.0, 0.0, 0.0}));
  EXPECT_EQ(column(t, "x_low"), (std::vector<double>{0.0, 0.3, 0.5}));
  double sum = 0.0;
  for (const double n : column(t, "count")) sum += n;
  EXPECT_EQ(sum, 900.0);  // those that are valid
  EXPECT_GT(column(t, "pd_low")[0], 0.95);
  EXPECT_LT(column(t, "pd_high")[1], 0.05);
  EXPECT_EQ(column(named(tables, "means_by_x"), "level_db").size(), 3U);
}

TEST(Summary, AxesByValueAndOverTwo) {
  const auto tables =
      summarise(asking({{{.column = "kind"}}, {{.column = "x", .bins = 4}, {.column = "kind"}}}),
                made_up(600));
  EXPECT_EQ(column(named(tables, "pd_by_kind"), "kind"), (std::vector<double>{0.0, 1.0, 2.0}));
  const SummaryTable& two = named(tables, "pd_by_x_and_kind");
  ASSERT_EQ(two.values[0].size(), 12U);
  double sum = 0.0;
  for (const double n : column(two, "count")) sum += n;
  EXPECT_EQ(sum, 540.0);
  EXPECT_EQ(column(two, "kind")[1], 1.0);  // the last axis is fastest
}

TEST(Summary, AGridOfManyValuesIsTakenByValueUnlessBinsAreAsked) {
  Table table = made_up(1000);
  for (std::size_t i = 0; i < 1000; ++i) table.values[0][i] = 100.0 * double(i % 40);
  const auto by_value = summarise(asking({{{.column = "x"}}}), table);
  EXPECT_EQ(named(by_value, "pd_by_x").values[0].size(), 36U);  // 25 valid rows to each
  const auto bins = summarise(asking({{{.column = "x", .bins = 5}}}), table);
  EXPECT_EQ(named(bins, "pd_by_x").values[0].size(), 5U);
}

// Ten draws or a thousand, this study or the next: the same bins, those of the law.
TEST(Summary, BinsOfAnInputAreThoseOfItsLaw) {
  Study study = asking({{{.column = "x", .bins = 4}}});
  const auto low_edges = [&](int rows) {
    return column(named(summarise(study, made_up(rows)), "pd_by_x"), "x_low");
  };
  EXPECT_NE(low_edges(30)[0], -1.0);
  study.variables = {{.name = "x", .keys = {"x"}, .law = NumberLaw{CutLaw(Uniform{-1.0, 3.0})}}};
  EXPECT_EQ(low_edges(30), (std::vector<double>{-1.0, 0.0, 1.0, 2.0}));
  EXPECT_EQ(low_edges(900), low_edges(30));
  // cut off below and endless above: up to what was drawn, as without a law
  study.variables[0].law = NumberLaw{CutLaw(Normal{0.5, 1.0}, -0.75)};
  EXPECT_EQ(low_edges(900)[0], -0.75);
  EXPECT_EQ(
      column(named(summarise(study, made_up(900)), "pd_by_x"), "x_high").back(),
      column(named(summarise(asking({{{.column = "x", .bins = 4}}}), made_up(900)), "pd_by_x"),
             "x_high")
          .back());
}

TEST(Summary, EqualCountsFillBinsAlike) {
  const auto tables =
      summarise(asking({{{.column = "x", .bins = 9, .equal_count = true}}}), made_up(1000));
  for (const double n : column(named(tables, "pd_by_x"), "count")) EXPECT_NEAR(n, 100.0, 1.0);
}

TEST(Summary, RocOfTwoExponentials) {
  // P_d = P_fa^(1/4); the area is 4/5.
  const auto tables = summarise(asking({}), made_up(5000));
  const SummaryTable& roc = named(tables, "roc");
  int outside = 0;
  for (std::size_t i = 0; i < roc.values[0].size(); ++i) {
    const double threshold = std::pow(10.0, 0.1 * column(roc, "threshold_db")[i]);
    const double pfa = std::exp(-threshold), pd = std::exp(-threshold / 4.0);
    outside += !(column(roc, "pd_low")[i] <= pd && pd <= column(roc, "pd_high")[i]);
    outside += !(column(roc, "pfa_low")[i] <= pfa && pfa <= column(roc, "pfa_high")[i]);
  }
  // 95 % intervals of strongly correlated figures: on the average a twentieth is outside.
  EXPECT_LT(outside, int(roc.values[0].size()) / 2);
  const SummaryTable& area = named(tables, "roc_area");
  EXPECT_NEAR(column(area, "area")[0], 0.8, 5.0 * 0.0045);  // Hanley & McNeil's error at 4500
  EXPECT_LT(column(area, "area_low")[0], column(area, "area")[0]);
}

TEST(Summary, SensitivityFindsWhatMatters) {
  const auto tables = summarise(asking({}), made_up(5000));
  const SummaryTable& t = named(tables, "sensitivity");
  // level = 3x + y + N(0, ½): variances 9/12, 1/12, 1/4 of 13/12.
  ASSERT_EQ(t.columns[0].labels[0], "level_db");
  EXPECT_NEAR(column(t, "first_order")[0], 9.0 / 13.0, 0.05);
  EXPECT_NEAR(column(t, "first_order")[1], 1.0 / 13.0, 0.05);
  EXPECT_NEAR(column(t, "first_order")[2], 0.0, 5.0 * column(t, "first_order_error")[2]);
  EXPECT_GT(column(t, "rank_correlation_low")[0], 0.7);
  EXPECT_TRUE(std::isnan(column(t, "rank_correlation")[2]));  // labels have no order
}

TEST(Summary, ConvergenceEndsAtTheWholeAndNarrows) {
  const auto tables = summarise(asking({}), made_up(4000));
  const SummaryTable& t = named(tables, "convergence");
  EXPECT_EQ(column(t, "count").back(), 3600.0);
  EXPECT_EQ(column(t, "pd").back(), [] {
    const Table table = made_up(4000);
    Moments m;
    for (std::size_t i = 0; i < 4000; ++i)
      if (table.valid[i] != 0) m.add(table.values[4][i]);
    return m.mean();
  }());
  const double first = column(t, "pd_high")[5] - column(t, "pd_low")[5];
  EXPECT_LT(column(t, "pd_high").back() - column(t, "pd_low").back(), 0.2 * first);
}

TEST(Summary, OfNoRowsIsEmptyNotAFault) {
  Table none = made_up(10);
  for (auto& values : none.values) values.clear();
  none.index.clear();
  none.valid.clear();
  EXPECT_NO_THROW(static_cast<void>(summarise(asking({{{.column = "x"}}}), none)));
  Table skipped = made_up(10);
  std::fill(skipped.valid.begin(), skipped.valid.end(), std::uint8_t{0});
  EXPECT_NO_THROW(static_cast<void>(summarise(asking({{{.column = "x"}}}), skipped)));
}

// What a reader of the file needs to know of its intervals.
TEST(Summary, SaysWhatItsIntervalsAre) {
  Study study = asking({});
  study.summary.confidence = 0.9;
  EXPECT_EQ(summary_of(study, made_up(100)).confidence, 0.9);
  EXPECT_EQ(summary_of(study, made_up(100)).proportion_interval, "wilson");
  EXPECT_EQ(summary_of(study, made_up(100)).intervals, "as of independent draws");
  study.design = Design::sobol;
  study.summary.interval = ProportionInterval::clopper_pearson;
  EXPECT_EQ(summary_of(study, made_up(100)).proportion_interval, "clopper_pearson");
  EXPECT_EQ(summary_of(study, made_up(100)).intervals,
            "as of independent draws: of this design, sobol, rather too wide than too narrow "
            "(docs/theory/studies.md)");
}

}  // namespace
}  // namespace asdic::detail::study
