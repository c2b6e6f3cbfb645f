#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "study/summary/saltelli.h"
#include "support/function_study.h"

// Indices of Saltelli's design against functions whose variance is known part by part.

namespace asdic::detail::study {
namespace {

using std::numbers::pi;
using support::column_named;
using support::Coverage;
using support::FunctionStudy;
using support::table_named;

FunctionStudy saltelli(std::uint64_t blocks, std::uint64_t seed, bool second_order) {
  FunctionStudy made;
  made.study.seed = seed;
  made.study.design = Design::saltelli;
  made.study.design_options.second_order = second_order;
  made.study.realisations = blocks;  // times their rows, below
  made.study.summary.convergence = made.study.summary.roc = false;
  return made;
}

void whole(FunctionStudy& made) { made.study.realisations *= saltelli_blocks(made.study).rows(); }

/// Ishigami & Homma (1990): sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁, x uniform in (−π, π).
struct Ishigami {
  static constexpr double a = 7.0, b = 0.1;
  double v1 = 0.5 * std::pow(1.0 + b * std::pow(pi, 4) / 5.0, 2), v2 = a * a / 8.0,
         v13 = b * b * std::pow(pi, 8) * 8.0 / 225.0, v = v1 + v2 + v13;
  std::vector<double> first{v1 / v, v2 / v, 0.0}, total{(v1 + v13) / v, v2 / v, v13 / v};
  double with_13 = v13 / v;

  static FunctionStudy study(std::uint64_t blocks, std::uint64_t seed, bool second_order) {
    FunctionStudy made = saltelli(blocks, seed, second_order);
    for (const char* name : {"x1", "x2", "x3"})
      made.study.variables.push_back(FunctionStudy::uniform(name, -pi, pi));
    made.of = [](std::span<const double> x, double) {
      return std::sin(x[0]) + a * std::pow(std::sin(x[1]), 2) +
             b * std::pow(x[2], 4) * std::sin(x[0]);
    };
    whole(made);
    return made;
  }
};

TEST(Sensitivity, IndicesOfIshigamiAreInTheirIntervalsAsOftenAsTheySay) {
  const Ishigami truth;
  for (const bool second_order : {false, true}) {
    std::vector<Coverage> first(3), total(3), pairs(3);
    Coverage mean, taken_for_rows, unexplained;
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
      const FunctionStudy made = Ishigami::study(300, seed, second_order);
      const Table table = made.table();
      const auto tables = summarise(made.study, table);
      const SummaryTable& t = table_named(tables, "sensitivity");
      for (std::size_t i = 0; i < 3; ++i) {
        first[i].add(column_named(t, "first_order")[i], column_named(t, "first_order_low")[i],
                     column_named(t, "first_order_high")[i], truth.first[i]);
        total[i].add(column_named(t, "total_order")[i], column_named(t, "total_order_low")[i],
                     column_named(t, "total_order_high")[i], truth.total[i]);
      }
      unexplained.add(column_named(t, "unexplained")[0], column_named(t, "unexplained_low")[0],
                      column_named(t, "unexplained_high")[0], truth.with_13);
      const auto& statistics = table_named(tables, "statistics");
      mean.add(column_named(statistics, "mean")[3], column_named(statistics, "mean_low")[3],
               column_named(statistics, "mean_high")[3], 3.5);
      Study as_rows = made.study;  // the interval of a mean as if all rows were independent
      as_rows.design = Design::random;
      as_rows.summary.sensitivity = false;
      const auto wrong = summarise(as_rows, table);
      const auto& wrong_statistics = table_named(wrong, "statistics");
      taken_for_rows.add(column_named(wrong_statistics, "mean")[3],
                         column_named(wrong_statistics, "mean_low")[3],
                         column_named(wrong_statistics, "mean_high")[3], 3.5);
      if (!second_order) continue;
      const SummaryTable& p = table_named(tables, "interactions");
      ASSERT_EQ(p.values[0].size(), 3U);  // 12, 13, 23
      for (std::size_t k = 0; k < 3; ++k)
        pairs[k].add(column_named(p, "second_order")[k], column_named(p, "second_order_low")[k],
                     column_named(p, "second_order_high")[k], k == 1 ? truth.with_13 : 0.0);
    }
    const auto check = [&](const Coverage& c, double value, const std::string& what) {
      EXPECT_GE(c.held, c.least()) << what << second_order;
      EXPECT_NEAR(c.half_width(), 1.96, 0.4) << what << second_order;
      // 150 studies: the mean is within five of its deviations, and a hundredth for V's own.
      EXPECT_NEAR(c.mean(), value, 5.0 * c.deviation() / std::sqrt(150.0) + 0.01) << what;
    };
    for (std::size_t i = 0; i < 3; ++i) {
      check(first[i], truth.first[i], "first " + std::to_string(i));
      check(total[i], truth.total[i], "total " + std::to_string(i));
      if (second_order) check(pairs[i], i == 1 ? truth.with_13 : 0.0, "pair " + std::to_string(i));
    }
    check(unexplained, truth.with_13, "unexplained");
    check(mean, 3.5, "mean");
    EXPECT_LT(taken_for_rows.held, taken_for_rows.least()) << "rows of a block are not independent";
  }
}

// An estimator that takes B for A (and A for B) is not the same: it must be seen.
TEST(Sensitivity, AWrongEstimatorIsFound) {
  const Ishigami truth;
  const FunctionStudy made = Ishigami::study(4000, 3, false);
  Table table = made.table();
  const std::size_t rows = saltelli_blocks(made.study).rows();
  const auto total = [&](const Table& of) {
    const auto tables = summarise(made.study, of);
    return column_named(table_named(tables, "sensitivity"), "total_order");
  };
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(total(table)[i], truth.total[i], 0.05) << i;
  for (std::size_t block = 0; block < 4000; ++block)
    std::swap(table.values[3][block * rows], table.values[3][block * rows + 1]);
  // Jansen's other formula: E[(f(B) − f(A_B^i))²]/2V is 1 − S_i.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(total(table)[i], 1.0 - truth.first[i], 0.06) << i;
}

/// Sobol's g: Π (|4x − 2| + a)/(1 + a); V_i = ⅓/(1 + a_i)², V = Π(1 + V_i) − 1.
TEST(Sensitivity, IndicesOfSobolsG) {
  const std::vector<double> a{0.0, 1.0, 4.5, 9.0};
  FunctionStudy made = saltelli(6000, 11, true);
  for (const char* name : {"x1", "x2", "x3", "x4"})
    made.study.variables.push_back(FunctionStudy::uniform(name, 0.0, 1.0));
  made.of = [a](std::span<const double> x, double) {
    double product = 1.0;
    for (std::size_t i = 0; i < 4; ++i)
      product *= (std::abs(4.0 * x[i] - 2.0) + a[i]) / (1.0 + a[i]);
    return product;
  };
  whole(made);
  std::vector<double> part;
  double all = 1.0;
  for (const double k : a) {
    part.push_back(1.0 / 3.0 / (1.0 + k) / (1.0 + k));
    all *= 1.0 + part.back();
  }
  const auto tables = summarise(made.study, made.table());
  const SummaryTable& t = table_named(tables, "sensitivity");
  for (std::size_t i = 0; i < 4; ++i) {
    // Five standard errors: half of the 95 % interval is two of them.
    const auto near = [&](const std::string& name, double value) {
      const double half = column_named(t, name + "_high")[i] - column_named(t, name + "_low")[i];
      EXPECT_NEAR(column_named(t, name)[i], value, 1.3 * half) << name << i;
      EXPECT_LT(half, 0.15) << name << i;
    };
    near("first_order", part[i] / (all - 1.0));
    near("total_order", part[i] * all / (1.0 + part[i]) / (all - 1.0));
  }
  const SummaryTable& pairs = table_named(tables, "interactions");
  for (std::size_t k = 0; k < 6; ++k) {
    const auto i = static_cast<std::size_t>(column_named(pairs, "input")[k]),
               j = static_cast<std::size_t>(column_named(pairs, "with")[k]);
    const double half =
        column_named(pairs, "second_order_high")[k] - column_named(pairs, "second_order_low")[k];
    EXPECT_NEAR(column_named(pairs, "second_order")[k], part[i] * part[j] / (all - 1.0),
                1.3 * half);
  }
}

/// x₁ + x₂e, all of variance 1: half of it is x₁'s, half is what x₂ and chance do together.
FunctionStudy with_chance(bool chance) {
  FunctionStudy made = saltelli(3000, 5, true);
  made.study.design_options.chance = chance;
  const double end = std::sqrt(3.0);
  for (const char* name : {"x1", "x2"})
    made.study.variables.push_back(FunctionStudy::uniform(name, -end, end));
  made.of = [end](std::span<const double> x, double e) {
    return x[0] + x[1] * end * (2.0 * e - 1.0);
  };
  whole(made);
  return made;
}

TEST(Sensitivity, ChanceIsAnInputThatRowsOfABlockShare) {
  for (const bool chance : {false, true}) {
    FunctionStudy made = with_chance(chance);
    const auto tables = summarise(made.study, made.table());
    const SummaryTable& t = table_named(tables, "sensitivity");
    ASSERT_EQ(t.values[0].size(), chance ? 3U : 2U);
    // Of 3000 blocks: five standard errors are below 0.08.
    for (std::size_t i = 0; i < t.values[0].size(); ++i) {
      EXPECT_NEAR(column_named(t, "first_order")[i], i == 0 ? 0.5 : 0.0, 0.08) << i;
      EXPECT_NEAR(column_named(t, "total_order")[i], 0.5, 0.08) << i;
    }
    EXPECT_NEAR(column_named(t, "unexplained")[0], 0.5, 0.08);
    if (chance) {
      EXPECT_EQ(t.columns[1].labels[2], "chance");
      const SummaryTable& pairs = table_named(tables, "interactions");
      for (std::size_t k = 0; k < 3; ++k)  // x1 x2, x1 chance, x2 chance
        EXPECT_NEAR(column_named(pairs, "second_order")[k], k == 2 ? 0.5 : 0.0, 0.12) << k;
    }
    made.chance_by_row = true;  // the wrong way: then chance is in every total order
    const auto wrong = summarise(made.study, made.table());
    EXPECT_GT(column_named(table_named(wrong, "sensitivity"), "total_order")[0], 0.8);
  }
}

// Columns that one law draws have one index; categories and profiles have theirs like numbers.
TEST(Sensitivity, GroupsAndCategories) {
  FunctionStudy made = saltelli(4000, 8, false);
  // two amplitudes of variance 1 each; a choice of 0, 1, 2 whose second column is its square
  made.study.variables.push_back(
      {.name = "profile",
       .keys = {"environment.sound_speed"},
       .origin = "",
       .law = ModesLaw{.depth = {0.0},
                       .mean = {1500.0},
                       .modes = {{1.0}, {1.0}},
                       .amplitudes = {CutLaw(Normal{0.0, 1.0}), CutLaw(Normal{0.0, 1.0})},
                       .interpolation = "c-linear"}});
  ChoiceLaw choice;
  for (const std::int64_t k : {0, 1, 2})
    choice.values.push_back({{.data = k, .origin = ""}, {.data = k * k, .origin = ""}});
  choice.cumulative = {1.0 / 3.0, 2.0 / 3.0, 1.0};
  choice.by_row = true;
  choice.labels = {{"low", "middle", "high"}, {}};
  made.study.variables.push_back(
      {.name = "sea", .keys = {"a.state", "a.square"}, .origin = "", .law = choice});
  made.of = [](std::span<const double> x, double) { return x[0] + x[0] * x[1] + x[2]; };
  whole(made);
  EXPECT_EQ(saltelli_blocks(made.study).rows(), 4U);
  const auto tables = summarise(made.study, made.table());
  const SummaryTable& t = table_named(tables, "sensitivity");
  ASSERT_EQ(t.values[0].size(), 2U);
  EXPECT_EQ(t.columns[1].labels, (std::vector<std::string>{"profile", "sea"}));
  const double v = 2.0 + 2.0 / 3.0;  // x₀ and x₀x₁ have 1 each, and no share of it alone
  EXPECT_NEAR(column_named(t, "first_order")[0], 2.0 / v, 0.1);
  EXPECT_NEAR(column_named(t, "total_order")[0], 2.0 / v, 0.1);
  EXPECT_NEAR(column_named(t, "first_order")[1], (2.0 / 3.0) / v, 0.05);
  EXPECT_NEAR(column_named(t, "total_order")[1], (2.0 / 3.0) / v, 0.05);
}

// Inputs of a group have one index, of all that they do alone and with each other: x₁ and x₃ of
// Ishigami's function leave nothing for x₂ to act with.
TEST(Sensitivity, NamedGroupsHaveOneIndex) {
  const Ishigami truth;
  FunctionStudy made = Ishigami::study(6000, 21, false);
  made.study.design_options.groups = {{"x3", "x1"}};
  EXPECT_EQ(saltelli_blocks(made.study).rows(), 4U);
  made.study.realisations = 6000 * 4;
  const auto tables = summarise(made.study, made.table());
  const SummaryTable& t = table_named(tables, "sensitivity");
  ASSERT_EQ(t.columns[1].labels, (std::vector<std::string>{"x1 + x3", "x2"}));
  const double both = (truth.v1 + truth.v13) / truth.v;
  for (const char* order : {"first_order", "total_order"}) {
    EXPECT_NEAR(column_named(t, order)[0], both, 0.06) << order;
    EXPECT_NEAR(column_named(t, order)[1], truth.first[1], 0.06) << order;
  }
  EXPECT_NEAR(column_named(t, "unexplained")[0], 0.0, 0.06);
}

// What never made a difference in a hundred blocks may make one: the interval says how much.
TEST(Sensitivity, AnInputThatRarelyMattersIsNotDeclaredDead) {
  Coverage rare;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    FunctionStudy made = saltelli(100, seed, false);
    made.measure = "detected";
    for (const char* name : {"x1", "x2"})
      made.study.variables.push_back(FunctionStudy::uniform(name, 0.0, 1.0));
    made.of = [](std::span<const double> x, double) {
      return (x[0] < 0.5) != (x[1] < 0.005) ? 1.0 : 0.0;
    };
    whole(made);
    const auto tables = summarise(made.study, made.table());
    const SummaryTable& t = table_named(tables, "sensitivity");
    // f changes where x2 crosses 0.005: 2·0.005·0.995 of the pairs; V = 1/4.
    rare.add(column_named(t, "total_order")[1], column_named(t, "total_order_low")[1],
             column_named(t, "total_order_high")[1], 0.5 * 2.0 * 0.005 * 0.995 / 0.25);
    EXPECT_NEAR(column_named(t, "total_order")[0], 1.0, 0.45);
  }
  EXPECT_GE(rare.held, rare.least());
}

// Blocks of which a row is not known are left out, and counted.
TEST(Sensitivity, BlocksThatAreNotWholeAreLeftOut) {
  const FunctionStudy made = Ishigami::study(200, 4, false);
  Table table = made.table();
  table.values[3][7] = std::nan("");  // block 1, A_B^1
  table.valid[10] = 0;                // block 2, A
  table.index.pop_back();             // block 199, A_B^3
  table.valid.pop_back();
  for (auto& column : table.values) column.pop_back();
  const auto tables = summarise(made.study, table);
  const SummaryTable& t = table_named(tables, "sensitivity");
  EXPECT_EQ(column_named(t, "count"), (std::vector<double>{198.0, 199.0, 198.0}));
  EXPECT_EQ(column_named(t, "left_out"), (std::vector<double>{2.0, 1.0, 2.0}));
}

// First orders alone: in another design the table says how much they leave out, and a note does.
TEST(Sensitivity, WhatFirstOrdersDoNotExplainIsTold) {
  Coverage first, left;
  std::string note;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    FunctionStudy made;
    made.study.seed = seed;
    made.study.realisations = 2000;
    made.study.summary.convergence = made.study.summary.roc = false;
    for (const char* name : {"x1", "x2"})
      made.study.variables.push_back(FunctionStudy::uniform(name, -1.0, 1.0));
    made.of = [](std::span<const double> x, double) { return x[0] + 2.0 * x[0] * x[1]; };
    const Summary summary = summary_of(made.study, made.table());
    const SummaryTable& t = table_named(summary.tables, "sensitivity");
    // Var x₁ = 1/3, Var 2x₁x₂ = 4/9.
    first.add(column_named(t, "first_order")[0], column_named(t, "first_order_low")[0],
              column_named(t, "first_order_high")[0], 3.0 / 7.0);
    left.add(column_named(t, "unexplained")[0], 0.0, 1.0, 4.0 / 7.0);
    ASSERT_EQ(summary.notes.size(), 1U);
    note = summary.notes[0];
  }
  EXPECT_GE(first.held, first.least(0.93));  // bins take something away
  EXPECT_NEAR(first.half_width(), 1.96, 0.5);
  EXPECT_NEAR(left.mean(), 4.0 / 7.0, 0.02);
  EXPECT_NE(note.find("% of the variance of level_db is of no input by itself"), std::string::npos);
}

}  // namespace
}  // namespace asdic::detail::study
