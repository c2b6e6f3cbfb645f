#include "study/measures/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "study/reader/study_reader.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

Study study_of(const std::string& design, std::uint64_t n, const std::string& vary) {
  const support::TemporaryDirectory folder;
  return read_study(folder.write(
      "study.toml", "[study]\nrealisations = " + std::to_string(n) + "\ndesign = \"" + design +
                        "\"\n[vary]\n" + vary + "[measure]\npaths = true\n" + support::plain_sea));
}

std::vector<double> column(const Study& study, std::size_t c) {
  const Sampler sampler(study);
  std::vector<double> values;
  for (std::uint64_t i = 0; i < study.realisations; ++i)
    values.push_back(sampler.draw(i).values[c]);
  return values;
}

const std::string wind = "\"environment.wind_speed\" = ";

TEST(Sampler, CategoriesAppearByTheirWeights) {
  const auto values = column(
      study_of("random", 6000,
               wind + "{ law = \"categorical\", values = [1, 2, 3], weights = [1, 2, 3] }\n"),
      0);
  std::map<double, double> counts;
  for (const double x : values) ++counts[x];
  for (const double k : {1.0, 2.0, 3.0})  // binomial, 4.9 standard deviations
    EXPECT_NEAR(counts[k], 1000.0 * k, 4.9 * std::sqrt(1000.0 * k * (1.0 - k / 6.0))) << k;
}

TEST(Sampler, DesignsOfEqualStrataDealChoicesEvenly) {
  // n strata over k values: each as often as any other, to one; of Sobol' points of 2^m, exactly.
  for (const auto& [design, n] :
       {std::pair<std::string, std::uint64_t>{"latin_hypercube", 1000}, {"sobol", 1024}}) {
    const auto values =
        column(study_of(design, n, wind + "{ law = \"grid\", values = [1, 2, 3, 4] }\n"), 0);
    std::map<double, std::uint64_t> counts;
    for (const double x : values) ++counts[x];
    for (const auto& [x, count] : counts) EXPECT_EQ(count, n / 4) << design << x;
  }
}

TEST(Sampler, ListsGoInTurnAndGridsRepeat) {
  const std::string list = wind + "{ law = \"list\", values = [5, 7, 9] }\n";
  for (const char* design : {"random", "latin_hypercube", "sobol", "grid"}) {
    const auto values = column(study_of(design, 9, list), 0);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(values[i], 5.0 + 2.0 * double(i % 3)) << design;
  }
}

TEST(Sampler, OnAGridOtherLawsAreDrawnAnew) {
  const Study study = study_of("grid", 400,
                               wind +
                                   "{ law = \"grid\", values = [1, 2] }\n"
                                   "\"target.0.strength_db\" = { law = \"normal\", mean = 10, "
                                   "deviation = 2 }\n");
  const auto strength = column(study, 1);
  double mean = 0.0;
  for (const double x : strength) mean += x / 400.0;
  EXPECT_NEAR(mean, 10.0, 4.9 * 2.0 / 20.0);
  EXPECT_NE(strength[0], strength[2]);  // the same point of the grid
}

TEST(Sampler, RowsMoveTogetherAndDiscsAreEvenInArea) {
  const Study rows = study_of("random", 50,
                              "pair = { keys = [\"environment.wind_speed\", "
                              "\"target.0.strength_db\"], law = \"categorical\", rows = [[1, 10], "
                              "[2, 20], [3, 30]] }\n");
  const auto speed = column(rows, 0), strength = column(rows, 1);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(strength[i], 10.0 * speed[i]);
  EXPECT_EQ(columns(rows)[1].name, "pair_strength_db");
  // P(range < r) = (r/R)²: half of the draws lie within R/√2, ± 4.9·√(1000)/2.
  const auto range = column(
      study_of("random", 1000, "\"target.0\" = { law = \"track\", radius = 5000, depth = 100 }\n"),
      0);
  const auto within = std::count_if(range.begin(), range.end(),
                                    [](double r) { return r < 5000.0 / std::sqrt(2.0); });
  EXPECT_NEAR(double(within), 500.0, 4.9 * std::sqrt(1000.0) / 2.0);
}

}  // namespace
}  // namespace asdic::detail::study
