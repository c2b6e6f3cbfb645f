#include <gtest/gtest.h>

#include <cmath>

#include "support/function_study.h"

// Errors of Sobol' points by independent scrambles, against means that are known.

namespace asdic::detail::study {
namespace {

using support::column_named;
using support::Coverage;
using support::FunctionStudy;
using support::table_named;

FunctionStudy sobol(std::uint64_t replicates, std::uint64_t points, std::uint64_t seed,
                    std::size_t inputs = 3) {
  FunctionStudy made;
  made.study.seed = seed;
  made.study.design = Design::sobol;
  made.study.design_options.replicates = replicates;
  made.study.realisations = replicates * points;
  made.study.summary.roc = made.study.summary.sensitivity = false;
  for (std::size_t i = 0; i < inputs; ++i)
    made.study.variables.push_back(FunctionStudy::uniform("x" + std::to_string(i), 0.0, 1.0));
  return made;
}

/// Smooth, and no sum of functions of one input each: Π(½ + x), its mean 1.
double smooth(std::span<const double> x, double) {
  double product = 1.0;
  for (const double u : x) product *= 0.5 + u;
  return product;
}

Coverage of_mean(std::uint64_t replicates, std::uint64_t points, int studies,
                 bool as_rows = false) {
  Coverage mean;
  for (int seed = 1; seed <= studies; ++seed) {
    FunctionStudy made = sobol(replicates, points, static_cast<std::uint64_t>(seed));
    made.of = smooth;
    const Table table = made.table();
    if (as_rows) made.study.design_options.replicates = 1;
    const auto tables = summarise(made.study, table);
    const SummaryTable& t = table_named(tables, "statistics");
    mean.add(column_named(t, "mean")[3], column_named(t, "mean_low")[3],
             column_named(t, "mean_high")[3], 1.0);
    const SummaryTable& c = table_named(tables, "convergence");
    EXPECT_NEAR(column_named(c, "level_db_high").back(), column_named(t, "mean_high")[3], 1e-12);
  }
  return mean;
}

// Of four replicates t is 3.18: with 1.96 in its place they would cover 0.855.
TEST(Replicates, IntervalsOfMeansCoverWhatTheySay) {
  for (const auto& [replicates, points, studies] :
       {std::tuple<std::uint64_t, std::uint64_t, int>{4, 32, 500}, {16, 32, 200}, {16, 21, 200}}) {
    const Coverage c = of_mean(replicates, points, studies);
    EXPECT_GE(c.held, c.least()) << replicates << ' ' << points;
    EXPECT_LE(studies - c.held, 0.05 * studies + 4.8 * std::sqrt(0.0475 * studies) + 1.0);
    EXPECT_GE(studies - c.held, 0.05 * studies - 4.8 * std::sqrt(0.0475 * studies) - 1.0);
    EXPECT_NEAR(c.mean(), 1.0, 5.0 * c.deviation() / std::sqrt(double(studies)));
  }
}

// Four times as many points: the width of independent draws would be halved.
TEST(Replicates, IntervalsShrinkFasterThanThoseOfIndependentDraws) {
  const Coverage few = of_mean(16, 16, 40), more = of_mean(16, 64, 40), most = of_mean(16, 256, 40);
  EXPECT_LT(more.width, 0.3 * few.width);
  EXPECT_LT(most.width, 0.3 * more.width);
  // What was said before of such a study: much too wide, and no faster than 1/√n.
  const Coverage as_rows = of_mean(16, 64, 40, true), as_more = of_mean(16, 256, 40, true);
  EXPECT_GT(as_rows.width, 5.0 * more.width);
  EXPECT_NEAR(as_more.width / as_rows.width, 0.5, 0.05);
}

// P(x₁ + x₂ + x₃ < 1) = 1/6, along x₁ and where it is rare.
TEST(Replicates, IntervalsOfProportionsCoverWhatTheySay) {
  Coverage all, rare, wide;
  std::vector<Coverage> bins(5);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    FunctionStudy made = sobol(16, 32, seed);
    made.measure = "detected";
    made.study.summary.by = {{{.column = "x0", .bins = 5}}};
    made.of = [](std::span<const double> x, double) {
      return x[0] + x[1] + x[2] < 1.0 ? 1.0 : 0.0;
    };
    const Table table = made.table();
    auto tables = summarise(made.study, table);
    const SummaryTable& t = table_named(tables, "statistics");
    all.add(column_named(t, "mean")[3], column_named(t, "mean_low")[3],
            column_named(t, "mean_high")[3], 1.0 / 6.0);
    const SummaryTable& by = table_named(tables, "pd_by_x0");
    for (std::size_t k = 0; k < 5; ++k) {
      const double low = 0.2 * double(k), high = low + 0.2;
      // The mean of (1 − x)²/2 over the bin.
      const double truth = (std::pow(1.0 - low, 3) - std::pow(1.0 - high, 3)) / 6.0 / 0.2;
      bins[k].add(column_named(by, "pd")[k], column_named(by, "pd_low")[k],
                  column_named(by, "pd_high")[k], truth);
    }
    made.study.design_options.replicates = 1;
    tables = summarise(made.study, table);
    const SummaryTable& w = table_named(tables, "statistics");
    wide.add(column_named(w, "mean")[3], column_named(w, "mean_low")[3],
             column_named(w, "mean_high")[3], 1.0 / 6.0);
    made.study.design_options.replicates = 16;
    made.of = [](std::span<const double> x, double) { return x[0] * x[1] < 1e-4 ? 1.0 : 0.0; };
    tables = summarise(made.study, made.table());
    const SummaryTable& r = table_named(tables, "statistics");
    rare.add(column_named(r, "mean")[3], column_named(r, "mean_low")[3],
             column_named(r, "mean_high")[3], 1e-4 * (1.0 + std::log(1e4)));
  }
  EXPECT_GE(all.held, all.least());
  EXPECT_LT(all.width, 0.75 * wide.width);
  for (const Coverage& bin : bins) EXPECT_GE(bin.held, bin.least());
  EXPECT_GE(rare.held, rare.least());
  EXPECT_GT(rare.width / rare.count, 3.6 / 512.0);  // rule of three: never narrower than ln 40/n
}

// 128 scrambles of 8 points have two below 1/4 each, and three in all between there and 1/4 +
// 3/1024: mostly one or none of them is seen. Their scatter alone would cover 0.86.
TEST(Replicates, CountsThatAreNearlyAlikeDoNotMakeAnEstimateExact) {
  Coverage share;
  const double truth = 0.25 + 3.05 / 1024.0;
  for (std::uint64_t seed = 1; seed <= 800; ++seed) {
    FunctionStudy made = sobol(128, 8, seed, 1);
    made.measure = "detected";
    made.study.summary.by.clear();
    made.study.summary.convergence = false;
    made.of = [&](std::span<const double> x, double) { return x[0] < truth ? 1.0 : 0.0; };
    const auto tables = summarise(made.study, made.table());
    const SummaryTable& t = table_named(tables, "statistics");
    share.add(column_named(t, "mean")[1], column_named(t, "mean_low")[1],
              column_named(t, "mean_high")[1], truth);
  }
  EXPECT_GE(share.held, share.least());
}

// One replicate is the design as it was; its points are the first replicate's.
TEST(Replicates, OneIsTheDesignAsItWas) {
  std::vector<double> u(5), v(5), w(5);
  const PointDesign plain(Design::sobol, 9, 0, 5), one(Design::sobol, 9, 0, 5, {.replicates = 1}),
      four(Design::sobol, 9, 0, 5, {.replicates = 4});
  for (std::uint64_t i = 0; i < 64; ++i) {
    plain.point(i, u);
    one.point(i, v);
    EXPECT_EQ(u, v);
    four.point(4 * i, w);
    for (std::size_t d = 0; d < 5; ++d) EXPECT_NEAR(u[d], w[d], 0x1p-31) << i;
  }
  // Others are other nets: each digit alike in half of the points.
  int alike = 0;
  for (std::uint64_t i = 0; i < 1024; ++i) {
    four.point(4 * i, u);
    four.point(4 * i + 1, v);
    alike += (u[0] < 0.5) == (v[0] < 0.5) && (u[1] < 0.5) == (v[1] < 0.5) &&
             (u[2] < 0.25) == (v[2] < 0.25);
  }
  EXPECT_LT(alike, 1024);
}

}  // namespace
}  // namespace asdic::detail::study
