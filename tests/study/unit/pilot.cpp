#include "study/pilot/pilot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <set>

#include "study/measures/row_cost.h"
#include "study/pilot/process_memory.h"
#include "study/reader/study_reader.h"

namespace asdic::detail::study {
namespace {

/// How often the interval holds what all rows cost, of `trials` studies of 2000 rows.
template <class Cost>
double coverage(std::uint64_t tried, const Cost& cost, int trials = 1500) {
  std::mt19937_64 random(7);
  int held = 0, without_end = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> known;
    double total = 0.0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const double x = cost(random);
      total += x;
      if (i < tried) known.push_back(x);
    }
    const Predicted made = predicted_total(known, 1, 2000, 0.95);
    const bool no_end = std::isnan(made.interval.high);
    without_end += no_end ? 1 : 0;
    held += made.interval.low <= total && (no_end || total <= made.interval.high) ? 1 : 0;
  }
  EXPECT_LE(without_end, 0.1 * trials);  // for laws that so many rows support
  return static_cast<double>(held) / trials;
}

// Of 1500 trials the counting error is 0.0056: 0.92 is five of them below 0.95. Of the second law
// with 16 rows, Student's t of the mean alone holds 0.86, mean ± 1.96 s/√n 0.84, about the median
// 0.65.
TEST(Prediction, IntervalHoldsByCounting) {
  std::lognormal_distribution<double> mild(0.0, 0.3), skewed(0.0, 1.0);
  std::gamma_distribution<double> gamma(2.0, 1.0);
  EXPECT_GE(coverage(16, [&](auto& r) { return mild(r); }), 0.93);
  EXPECT_GE(coverage(16, [&](auto& r) { return skewed(r); }), 0.92);
  EXPECT_GE(coverage(16, [&](auto& r) { return gamma(r); }), 0.93);
  EXPECT_GE(coverage(5, [&](auto& r) { return gamma(r); }), 0.93);
}

// Of 16 rows the greatest is nearly always below that of 2000: it must not stand for it.
TEST(Prediction, GreatestRowHoldsByCounting) {
  std::mt19937_64 random(11);
  constexpr int trials = 1500;
  for (const double sigma : {0.3, 1.0}) {
    std::lognormal_distribution<double> law(0.0, sigma);
    int held = 0, below = 0, held_by_tried = 0, without_end = 0;
    for (int trial = 0; trial < trials; ++trial) {
      std::vector<double> known;
      double most = 0.0;
      for (int i = 0; i < 2000; ++i) {
        const double x = law(random);
        most = std::max(most, x);
        if (i < 16) known.push_back(x);
      }
      const Predicted made = predicted_greatest(known, 2000, 0.95, 1e-3);
      held += made.interval.low <= most && !(most > made.interval.high) ? 1 : 0;
      without_end += std::isnan(made.interval.high) ? 1 : 0;
      below += made.total < most ? 1 : 0;
      held_by_tried += most <= *std::max_element(known.begin(), known.end()) ? 1 : 0;
    }
    EXPECT_GE(held, 0.92 * trials) << sigma;
    EXPECT_NEAR(below, 0.5 * trials, 0.12 * trials) << sigma;
    EXPECT_LE(held_by_tried, 0.02 * trials) << sigma;
    EXPECT_LE(without_end, 0.1 * trials) << sigma;
  }
  const std::vector<double> one{2.0}, all{1.0, 4.0}, small{0.0, 1.0, 3.0};
  EXPECT_TRUE(std::isnan(predicted_greatest(one, 10, 0.95, 1e-3).interval.high));
  EXPECT_EQ(predicted_greatest(all, 2, 0.95, 1e-3).total, 4.0);
  // Rows that take next to nothing are as good as alike.
  EXPECT_NEAR(predicted_greatest(small, 1000, 0.95, 1e6).interval.high, 1e6, 1.0);
}

// For rows of 0.1, 10 and 0.1 s a log-normal law with their scatter (σ = 2.7) has its 97.5 %
// quantile some 10⁵ times above the mean, which three rows cannot support.
TEST(Prediction, NoUpperBoundThatTheRowsDoNotSupport) {
  const std::vector<double> uneven{0.1, 10.0, 0.1};
  const Predicted all = predicted_total(uneven, 1, 1000, 0.95);
  EXPECT_NEAR(all.total, 1000.0 * 10.2 / 3.0, 1e-6);
  EXPECT_TRUE(std::isnan(all.interval.high));
  EXPECT_GE(all.interval.low, 10.2);
  const Predicted most = predicted_greatest(uneven, 1000, 0.95, 1e-3);
  EXPECT_EQ(most.total, 10.0);
  EXPECT_TRUE(std::isnan(most.interval.high));
}

TEST(Prediction, MeanAndNotMedianTimesRows) {
  // of a log-normal law with σ = 1 the median is e^(-1/2) = 0.61 of the mean
  std::mt19937_64 random(3);
  std::lognormal_distribution<double> law(0.0, 1.0);
  std::vector<double> known;
  for (int i = 0; i < 4000; ++i) known.push_back(law(random));
  const Predicted made = predicted_total(known, 1, 1000000, 0.95);
  EXPECT_NEAR(made.total / 1e6, std::exp(0.5), 0.08);
}

TEST(Prediction, NothingIsLeftToPredictWhereAllIsKnown) {
  const std::vector<double> all{1.0, 2.0, 4.0};
  const Predicted made = predicted_total(all, 1, 3, 0.95);
  EXPECT_DOUBLE_EQ(made.total, 7.0);
  EXPECT_DOUBLE_EQ(made.interval.low, 7.0);
  EXPECT_DOUBLE_EQ(made.interval.high, 7.0);
  const Predicted blocks = predicted_total(std::vector<double>{1.0, 2.0}, 8, 80, 0.95);
  EXPECT_DOUBLE_EQ(blocks.total, 80 * 1.5) << "means of blocks stand for eight rows each";
}

TEST(Prediction, RowsToTryAreSpreadAndWholeBlocks) {
  const auto rows = rows_to_try(1000, 10, 1);
  ASSERT_EQ(rows.size(), 10U);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_GE(rows[k], 100 * k);
    EXPECT_LT(rows[k], 100 * (k + 1));
  }
  EXPECT_EQ(rows, rows_to_try(1000, 10, 1)) << "the same each time";
  const auto blocks = rows_to_try(80, 4, 8);
  ASSERT_EQ(blocks.size(), 32U);
  for (std::size_t k = 0; k < blocks.size(); ++k) EXPECT_EQ(blocks[k] % 8, k % 8);
  EXPECT_EQ(rows_to_try(3, 16, 1).size(), 3U);
}

Study known_answer(std::vector<std::string> set) {
  return read_study(std::filesystem::path(ASDIC_SCENARIOS) / "studies/known_answer.toml", set);
}

/// The prediction against what all rows took, by the processor's clock of this process.
TEST(Pilot, PredictsWhatTheWholeTakes) {
  const Study study = known_answer({"study.realisations=400"});
  const Pilot made = pilot(study, {.rows = 40, .changed = 2});
  ASSERT_EQ(made.rows.size(), 40U);
  EXPECT_EQ(made.count, 400U);
  const Realiser realiser(study);
  double took = 0.0;
  for (std::uint64_t index = 0; index < 400; ++index) {
    RowCost cost;
    static_cast<void>(realiser.realise(index, &cost));
    took += cost.total;
  }
  // Rows of half a millisecond on a machine that others use, too, whose caches they empty: a factor
  // that tells a sum from a mean, and no more.
  EXPECT_LT(made.processor.total, 10.0 * took);
  EXPECT_GT(made.processor.total, 0.1 * took);
  EXPECT_LE(made.processor.interval.low, made.processor.total);
  EXPECT_GE(made.processor.interval.high, made.processor.total);
  double stages = 0.0;
  for (const double stage : made.mean.stages) stages += stage;
  EXPECT_LE(stages, 1.001 * made.mean.total) << "no time is told twice";
  EXPECT_GE(stages, 0.8 * made.mean.total) << "nearly all of a row's time has a stage";
}

/// Rows of a pilot are those of the study, and asking what they cost changes none of their bits.
TEST(Pilot, AskingChangesNoRow) {
  const Study study = known_answer({"study.realisations=50"});
  const Realiser one(study), other(study);
  for (const std::uint64_t index : {0U, 17U, 49U}) {
    RowCost cost;
    const Row asked = one.realise(index, &cost), plain = other.realise(index);
    EXPECT_EQ(asked.values, plain.values);
    EXPECT_GT(cost.total, 0.0);
  }
}

/// Detection by 24 draws costs more than levels alone, and the pilot finds which key does it.
TEST(Pilot, FindsTheKeyThatDominates) {
  const std::vector<std::string> set{"study.realisations=100",
                                     "measure.matched_filter.background=expected"};
  const Study study = known_answer(set);
  const Pilot made = pilot(study, {.rows = 6, .set = set});
  ASSERT_FALSE(made.turned.empty());
  ASSERT_EQ(made.refused.size(), 1U) << "the table of the matched filter asks for a detection";
  EXPECT_EQ(made.refused.front().overrides.front(), "measure.detection=false");
  double draws = 0.0, trend = 0.0;
  for (const Turned& turned : made.turned) {
    if (turned.candidate.overrides.front() == "measure.matched_filter.draws=8")
      draws = turned.share;
    if (turned.candidate.overrides.front() == "measure.matched_filter.background=\"trend\"")
      trend = turned.share;
  }
  EXPECT_GT(draws, 0.0) << "was tried";
  EXPECT_GT(trend, 0.0);
  EXPECT_GT(made.mean[Stage::draws], 0.0);
  if (std::getenv("ASDIC_DEEP") == nullptr) return;  // shares of milliseconds on a busy machine
  EXPECT_LT(draws, 0.75) << "a third of the draws";
  EXPECT_LT(trend, 0.9) << "no draws, but the samples around the echo";
  EXPECT_GT(made.mean[Stage::draws], 0.5 * made.mean.total);
  EXPECT_TRUE(
      made.turned.front().candidate.overrides.front().starts_with("measure.matched_filter"));
}

TEST(Pilot, MemoryOfWorkIsSeen) {
  const double took = taken_by([] {
    std::vector<char> large(200000000, 1);
    ASSERT_EQ(large[7], 1);
  });
  if (std::isnan(took)) GTEST_SKIP() << "this system does not tell";
  EXPECT_GT(took, 190e6);
  EXPECT_LT(took, 260e6);
  const double again = taken_by([] {});
  EXPECT_LT(again, 20e6) << "earlier work's peak is not this one's";
}

}  // namespace
}  // namespace asdic::detail::study
