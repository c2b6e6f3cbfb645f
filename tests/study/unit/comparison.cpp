// Studies compared row by row. Truth: exact sums over the binomial and trinomial laws, closed forms
// of Student's t, and counting how often intervals hold what they should.
#include "study/comparison/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/error.h"
#include "study/comparison/paired.h"
#include "study/sampling/law.h"
#include "study/summary/clustered_mean.h"
#include "support/summary_tables.h"

namespace asdic::detail::study {
namespace {

// McNemar's exact test: two-sided tail of fair coins, summed term by term.
TEST(PairedProportions, HaveTheBinomialTail) {
  for (const auto& [x, y] : {std::pair{3, 12}, {0, 6}, {7, 7}, {1, 0}, {40, 65}}) {
    const int n = x + y, k = std::min(x, y);
    double tail = 0.0;
    for (int i = 0; i <= k; ++i)
      tail += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) -
                       n * std::log(2.0));
    const auto found = difference_of_proportions(
        {.only_first = double(x), .only_second = double(y), .all = 200.0}, 0.95);
    EXPECT_NEAR(found.p_value, std::min(1.0, 2.0 * tail), 1e-10) << x << ' ' << y;
    EXPECT_NEAR(found.value, (y - x) / 200.0, 1e-15);
  }
}

// No pair differs: the score is √(nδ/(1 − δ)), so the limits are ±z²/(n + z²).
TEST(PairedProportions, HaveALimitWhereNoPairDiffers) {
  const double z = two_sided(0.95), limit = z * z / (50.0 + z * z);
  const auto found = difference_of_proportions({.all = 50.0}, 0.95);
  EXPECT_NEAR(found.interval.low, -limit, 1e-12);
  EXPECT_NEAR(found.interval.high, limit, 1e-12);
  EXPECT_EQ(found.p_value, 1.0);
}

// The other way round it is the negative.
TEST(PairedProportions, AreAntisymmetric) {
  const auto one = difference_of_proportions({.only_first = 3, .only_second = 20, .all = 60}, 0.9);
  const auto two = difference_of_proportions({.only_first = 20, .only_second = 3, .all = 60}, 0.9);
  EXPECT_NEAR(one.interval.low, -two.interval.high, 1e-12);
  EXPECT_NEAR(one.interval.high, -two.interval.low, 1e-12);
  EXPECT_NEAR(one.p_value, two.p_value, 1e-15);
}

/// How often the interval holds the difference, summed over the trinomial law of 60 pairs. \param
/// interval  of the pairs with the first alone, with the second alone
template <class OfPairs>
double coverage(double p, double q, OfPairs&& interval) {
  constexpr int n = 60;
  double held = 0.0;
  for (int x = 0; x <= n; ++x)
    for (int y = 0; x + y <= n; ++y) {
      const double log_p = std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(y + 1.0) -
                           std::lgamma(n - x - y + 1.0) + x * std::log(p) + y * std::log(q) +
                           (n - x - y) * std::log1p(-p - q);
      const Interval found = interval(x, y);
      if (found.low <= q - p && q - p <= found.high) held += std::exp(log_p);
    }
  return held;
}

TEST(PairedProportions, HoldTheDifferenceAsOftenAsTheySay) {
  const auto score = [](int x, int y) {
    return difference_of_proportions(
               {.only_first = double(x), .only_second = double(y), .all = 60.0}, 0.95)
        .interval;
  };
  // As if the two had been seen in other realisations: the same counts, no pairs. With a rate of
  // one half each, it is far too wide.
  const auto unpaired = [](int x, int y) {
    const double d = (y - x) / 60.0, half = 1.96 * std::sqrt(2.0 * 0.25 / 60.0);
    return Interval{d - half, d + half};
  };
  // Wald's: nothing where no pair differs.
  const auto wald = [](int x, int y) {
    const double d = (y - x) / 60.0, half = 1.96 * std::sqrt(((x + y) / 60.0 - d * d) / 60.0);
    return Interval{d - half, d + half};
  };
  double least_of_wald = 1.0;
  for (const auto& [p, q] :
       {std::pair{0.05, 0.05}, {0.03, 0.12}, {0.1, 0.2}, {0.2, 0.35}, {0.4, 0.3}})
    EXPECT_NEAR(coverage(p, q, score), 0.95, 0.02) << p << ' ' << q;
  for (const auto& [p, q] : {std::pair{0.01, 0.02}, {0.002, 0.03}, {0.02, 0.1}}) {
    EXPECT_GT(coverage(p, q, score), 0.93) << p << ' ' << q;  // few pairs differ: not too narrow
    least_of_wald = std::min(least_of_wald, coverage(p, q, wald));
  }
  EXPECT_GT(coverage(0.05, 0.1, unpaired), 0.99);
  EXPECT_LT(least_of_wald, 0.9);
}

// Student's law of 1 and 2 degrees of freedom is known in closed form.
TEST(Student, HasItsClosedForms) {
  for (const double p : {0.5, 0.1, 0.05, 1e-3}) {
    EXPECT_NEAR(student(1.0 - p, 1.0), std::tan(0.5 * M_PI * (1.0 - p)),
                1e-9 * std::tan(0.5 * M_PI * (1.0 - p)));
    const double a = 1.0 - p;  // P(|t| < T) = T/√(2 + T²)
    EXPECT_NEAR(student(1.0 - p, 2.0), a * std::sqrt(2.0 / (1.0 - a * a)), 1e-8);
  }
  EXPECT_NEAR(student(0.95, 1e7), two_sided(0.95), 1e-6);
}

TEST(PairedMeans, HoldTheDifferenceAsOftenAsTheySay) {
  std::mt19937_64 chance(3);
  std::normal_distribution<double> normal(0.7, 2.0);
  int held = 0, normal_held = 0;
  constexpr int trials = 20000;
  for (int trial = 0; trial < trials; ++trial) {
    Moments moments;
    for (int i = 0; i < 5; ++i) moments.add(normal(chance));
    const auto found = difference_of_means(moments, 0.95);
    held += found.interval.low <= 0.7 && 0.7 <= found.interval.high ? 1 : 0;
    const Interval other = moments.mean_interval(0.95);  // z of a normal: too narrow for five
    normal_held += other.low <= 0.7 && 0.7 <= other.high ? 1 : 0;
  }
  EXPECT_NEAR(double(held) / trials, 0.95, 0.005);
  EXPECT_LT(double(normal_held) / trials, 0.9);
}

// Two sonars in one sea. Their Pd falls with range, that of the second from 10 km on: up to there
// they are alike, beyond it the second detects 20 % more.
class TwoSonars : public testing::Test {
 protected:
  TwoSonars() {
    std::mt19937_64 chance(5);
    std::uniform_real_distribution<double> uniform;
    Study study;
    study.seed = 4;
    for (const char* name : {"range", "snr"})
      study.variables.push_back({.name = name, .keys = {name}, .origin = "", .law = {}});
    studies_ = {study, study};
    const std::vector<Column> columns{
        {.name = "range", .unit = "m", .meaning = "", .role = Column::Role::input, .labels = {}},
        {.name = "depth", .unit = "m", .meaning = "", .role = Column::Role::input, .labels = {}},
        {.name = "detected", .unit = "1", .meaning = "detected", .labels = {}},
        {.name = "range_error", .unit = "m", .meaning = "error", .labels = {}}};
    first_ = second_ = Table{.columns = columns, .index = {}, .valid = {}, .values = {}};
    for (Table* table : {&first_, &second_}) table->values.resize(columns.size());
    for (std::uint64_t i = 0; i < 4000; ++i) {
      const double range = 20e3 * uniform(chance), luck = uniform(chance), error = uniform(chance);
      const double pd = 0.5, more = range > 10e3 ? 0.2 : 0.0;
      const auto add = [&](Table& to, std::vector<double> row) {
        to.index.push_back(i);
        to.valid.push_back(1);
        for (std::size_t c = 0; c < row.size(); ++c) to.values[c].push_back(row[c]);
      };
      add(first_, {range, 5.0, luck < pd ? 1.0 : 0.0, 100.0 * error});
      if (i != 17)  // a row that the second does not have
        add(second_, {range, 90.0, luck < pd + more ? 1.0 : 0.0, 100.0 * error - 10.0});
    }
  }
  [[nodiscard]] Comparison compared() const {
    return compare({{.name = "hull", .study = &studies_[0], .table = first_},
                    {.name = "towed", .study = &studies_[1], .table = second_}});
  }
  static const SummaryTable& table(const Comparison& of, const std::string& name) {
    return named(of.summary.tables, name);
  }

  std::vector<Study> studies_;
  Table first_, second_;
};

TEST_F(TwoSonars, AreComparedWhereTheyShareTheSea) {
  const Comparison found = compared();
  EXPECT_EQ(found.rows, 3999U);
  EXPECT_EQ(found.inputs, std::vector<std::string>{"range"});
  EXPECT_EQ(found.unlike_inputs, std::vector<std::string>{"depth"});
  const SummaryTable& all = table(found, "differences");
  ASSERT_EQ(column(all, "hull_to_towed").size(), 2U);
  EXPECT_NEAR(column(all, "hull_to_towed")[0], 0.1, 0.015);
  EXPECT_NEAR(column(all, "hull_to_towed")[1], -10.0, 1e-9);
  EXPECT_EQ(column(all, "best")[0], 1.0);
  EXPECT_EQ(column(all, "best")[1], 1.0);  // of errors the least
  // In pairs it is known far better than of two seas: √(0.1·0.9/n) against √(2·0.25/n).
  EXPECT_LT(column(all, "hull_to_towed_high")[0] - column(all, "hull_to_towed_low")[0],
            2.2 * 1.96 * std::sqrt(0.09 / 3999.0));
}

TEST_F(TwoSonars, OneIsBetterWhereItIs) {
  const Comparison found = compared();
  const SummaryTable& by = table(found, "pd_by_range");
  const auto &middle = column(by, "range"), &best = column(by, "best"),
             &difference = column(by, "hull_to_towed");
  ASSERT_EQ(middle.size(), 10U);
  for (std::size_t i = 0; i < middle.size(); ++i) {
    const bool far = middle[i] > 10e3;
    EXPECT_NEAR(difference[i], far ? 0.2 : 0.0, 0.08) << middle[i];
    EXPECT_EQ(best[i] == 1.0, far) << middle[i];
    EXPECT_EQ(std::isnan(best[i]), !far) << middle[i];
  }
}

// How well a difference is known: of all rows, of the worst bin, and by a rule.
TEST_F(TwoSonars, KnowTheirDifferenceAsWellAsTheWorstBin) {
  const Comparison found = compared();
  const std::vector<std::string> names{"hull", "towed"};
  const auto known = [&](UntilTarget target) {
    return known_difference(first_.columns, found, names, target);
  };
  const auto rule = [](const std::string& text) {
    return Expression(text, names_of_rules(), "here");
  };
  const SummaryTable &all = table(found, "differences"), &by = table(found, "pd_by_range");
  const Known pd = known({.name = "", .half_width = 0.01});
  EXPECT_EQ(pd.name, "pd");
  EXPECT_EQ(pd.where, "towed less hull");
  EXPECT_DOUBLE_EQ(pd.half_width, 0.5 * (column(all, "hull_to_towed_high")[0] -
                                         column(all, "hull_to_towed_low")[0]));
  EXPECT_TRUE(pd.enough());  // 0.0093
  double worst = 0.0;
  for (std::size_t i = 0; i < 10; ++i)
    worst = std::max(
        worst, 0.5 * (column(by, "hull_to_towed_high")[i] - column(by, "hull_to_towed_low")[i]));
  const UntilTarget bins{.name = "pd_by_range",
                         .half_width = 0.03,
                         .column = "detected",
                         .axes = {{.column = "range"}}};
  EXPECT_DOUBLE_EQ(known(bins).half_width, worst);
  EXPECT_FALSE(known(bins).enough());
  EXPECT_TRUE(
      known({.name = "pd", .rule = rule("low > 0 || high < 0"), .column = "detected"}).enough());
  EXPECT_FALSE(known({.name = "pd", .rule = rule("low > 0.2"), .column = "detected"}).enough());
  UntilTarget decided = bins;
  decided.rule = rule("low > 0 || high < 0");
  const Known near = known(decided);
  EXPECT_FALSE(near.enough());  // up to 10 km nobody is better
  EXPECT_TRUE(near.where.starts_with("towed less hull, range 999.")) << near.where;
  decided.rule = rule("half_width < 0.1 && rows > 300");
  EXPECT_TRUE(known(decided).enough());
}

TEST_F(TwoSonars, SayWhichIsBetterAndOfWhatNobodyCan) {
  EXPECT_EQ(compared().better, (std::vector<Better>{Better::greatest, Better::least}));
  EXPECT_EQ(better({.name = "noise_level_db"}), Better::neither);
  EXPECT_EQ(better({.name = "position_error_rock"}), Better::least);
  EXPECT_EQ(better({.name = "time_to_decide", .formula = "paths", .least_best = true}),
            Better::least);
  EXPECT_EQ(better({.name = "detected_soon", .formula = "paths"}), Better::neither);
}

TEST(Comparison, GoesOnInRounds) {
  Study study;
  EXPECT_EQ(rounds_of(study, 3000), (std::vector<std::uint64_t>{100, 200, 500, 1000, 2000, 3000}));
  EXPECT_EQ(rounds_of(study, 60), (std::vector<std::uint64_t>{60}));
  study.design = Design::sobol;
  study.design_options.replicates = 16;  // 128 = 16·8, 192 = 16·12, …
  EXPECT_EQ(rounds_of(study, 512), (std::vector<std::uint64_t>{128, 192, 256, 384, 512}));
}

TEST_F(TwoSonars, OfOtherSeedsAreNotCompared) {
  studies_[1].seed = 5;
  EXPECT_THROW(static_cast<void>(compared()), InputError);
}

TEST(Comparison, NamesStudiesByTheirFiles) {
  EXPECT_EQ(names_of({"a/Hull-1.toml", "b/towed.toml", "c/towed.toml"}),
            (std::vector<std::string>{"hull_1", "towed", "towed_2"}));
}

}  // namespace
}  // namespace asdic::detail::study
