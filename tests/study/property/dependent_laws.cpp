#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/units.h"
#include "study/measures/sampler.h"
#include "study/reader/study_reader.h"
#include "study/summary/law_tables.h"
#include "support/kolmogorov.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// Inputs that look at others: conditional laws, formulae, correlation.

namespace asdic::detail::study {
namespace {

constexpr std::uint64_t n = 6000;

Study study_of(const std::string& vary, const std::string& design = "random",
               std::uint64_t realisations = n) {
  const support::TemporaryDirectory folder;
  return read_study(
      folder.write("study.toml", "[study]\nrealisations = " + std::to_string(realisations) +
                                     "\ndesign = \"" + design + "\"\n[vary]\n" + vary +
                                     "[measure]\npaths = true\n" + support::plain_sea));
}

std::string fault_of(const std::string& vary) {
  try {
    static_cast<void>(study_of(vary));
  } catch (const InputError& error) {
    const std::string text = error.what();
    return text.substr(text.find("study.toml"));
  }
  return "no fault";
}

/// The draws of a study, by column.
std::map<std::string, std::vector<double>> drawn(const Study& study) {
  const Sampler sampler(study);
  std::map<std::string, std::vector<double>> columns;
  for (std::uint64_t i = 0; i < study.realisations; ++i) {
    const Sampler::Drawn row = sampler.draw(i);
    for (std::size_t c = 0; c < row.values.size(); ++c)
      columns[sampler.columns()[c].name].push_back(row.values[c]);
  }
  return columns;
}

std::vector<double> where(const std::vector<double>& x, const std::vector<double>& is,
                          double value) {
  std::vector<double> some;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (is[i] == value) some.push_back(x[i]);
  return some;
}

/// Kolmogorov–Smirnov: below 2.69 but for one case in 10⁶.
template <class Law>
double distance(const std::vector<double>& x, Law&& law) {
  return support::kolmogorov_distance(x, law) * std::sqrt(double(x.size()));
}

std::vector<double> ranks(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return x[a] < x[b]; });
  std::vector<double> rank(x.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = double(i);
  return rank;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto mean = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / double(v.size());
  };
  const double mx = mean(x), my = mean(y);
  double xy = 0.0, xx = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mx) * (y[i] - my);
    xx += (x[i] - mx) * (x[i] - mx);
    yy += (y[i] - my) * (y[i] - my);
  }
  return xy / std::sqrt(xx * yy);
}

const std::string season =
    "season = { law = \"categorical\", values = [\"winter\", \"summer\"], weights = [1, 2], keys "
    "= [] }\n";

// Rayleigh's law of mean 10 in winter and of mean 5 in summer.
TEST(DependentLaws, EachBranchHasItsLaw) {
  const auto x = drawn(study_of(
      season +
      "\"environment.wind_speed\" = { given = \"season\", laws = { summer = { law = \"rayleigh\", "
      "mean = 5.0 }, winter = { law = \"rayleigh\", mean = 10.0 } } }\n"));
  const auto rayleigh = [](double mean) {
    return [=](double v) { return 1.0 - std::exp(-pi / 4.0 * v * v / (mean * mean)); };
  };
  const auto winter = where(x.at("wind_speed"), x.at("season"), 0.0),
             summer = where(x.at("wind_speed"), x.at("season"), 1.0);
  EXPECT_NEAR(double(winter.size()), double(n) / 3.0, 4.9 * std::sqrt(double(n) * 2.0 / 9.0));
  EXPECT_LT(distance(winter, rayleigh(10.0)), 2.69);
  EXPECT_LT(distance(summer, rayleigh(5.0)), 2.69);
  EXPECT_GT(distance(winter, rayleigh(5.0)), 2.69);
  EXPECT_GT(distance(summer, rayleigh(10.0)), 2.69);
  // All together: the mixture.
  const auto mixture = [&](double v) { return rayleigh(10.0)(v) / 3.0 + rayleigh(5.0)(v) / 1.5; };
  EXPECT_LT(distance(x.at("wind_speed"), mixture), 2.69);
}

// Intervals of a number; a branch within a branch; the file's order is the other way round.
TEST(DependentLaws, OrderFollowsWhatLooksAtWhat) {
  const std::string strength =
      "\"target.0.strength_db\" = { given = \"wind_speed\", edges = [5.0, 10.0], laws = [ { law = "
      "\"uniform\", low = 0, high = 1 }, { given = \"season\", laws = { winter = { law = "
      "\"uniform\", low = 1, high = 2 }, otherwise = { law = \"uniform\", low = 2, high = 3 } } }, "
      "{ law = \"expression\", value = \"wind_speed\" } ] }\n";
  const std::string wind =
      "\"environment.wind_speed\" = { law = \"uniform\", low = 0.0, high = 15.0 }\n";
  const auto x = drawn(study_of(strength + wind + season));
  ASSERT_EQ(x.at("strength_db").size(), n);
  double inner = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = x.at("wind_speed")[i], s = x.at("strength_db")[i];
    if (w >= 10.0) {
      EXPECT_EQ(s, w);
    } else {
      const double least = w < 5.0 ? 0.0 : x.at("season")[i] == 0.0 ? 1.0 : 2.0;
      EXPECT_GE(s, least);
      EXPECT_LE(s, least + 1.0);
      inner += w >= 5.0;
    }
  }
  EXPECT_NEAR(inner, double(n) / 3.0, 4.9 * std::sqrt(double(n) * 2.0 / 9.0));
  // The columns stand as in the file.
  const Sampler sampler(study_of(strength + wind + season));
  EXPECT_EQ(sampler.columns()[0].name, "strength_db");
  EXPECT_EQ(sampler.columns()[2].name, "season");
}

TEST(DependentLaws, AFormulaIsExact) {
  const auto x = drawn(study_of(
      "\"noise.spectral_level_db\" = { law = \"expression\", value = \"30 + 0.5 * wind_speed + "
      "more\" }\n"
      "more = { law = \"normal\", mean = 0.0, deviation = 2.0, keys = [] }\n"
      "\"environment.wind_speed\" = { law = \"weibull\", shape = 2.0, mean = 7.0 }\n"));
  for (std::size_t i = 0; i < n; ++i)
    EXPECT_EQ(x.at("spectral_level_db")[i], 30.0 + 0.5 * x.at("wind_speed")[i] + x.at("more")[i]);
}

// Inputs that look at none keep their draws, whoever else is there; one without a key writes none.
TEST(DependentLaws, WhatStandsBeforeKeepsItsDraws) {
  const std::string wind =
      "\"environment.wind_speed\" = { law = \"weibull\", shape = 2.0, mean = 7.0 }\n";
  const auto alone = drawn(study_of(wind));
  const auto more = drawn(study_of(wind + season +
                                   "\"target.0.strength_db\" = { law = \"expression\", value = "
                                   "\"wind_speed\" }\n"));
  EXPECT_EQ(alone.at("wind_speed"), more.at("wind_speed"));
}

// Casts of a season: a label is of its own branch, and what is written is the branch's profile.
TEST(DependentLaws, CastsOfASeason) {
  const auto cast = [](double speed) {
    return "{ depth = [0.0, 1000.0], speed = [" + std::to_string(speed) + ", " +
           std::to_string(speed) + "] }";
  };
  const Study study = study_of(season +
                               "profile = { given = \"season\", laws = { winter = { law = "
                               "\"profile_casts\", casts = [" +
                               cast(1480.0) + ", " + cast(1485.0) +
                               "] }, summer = { law = \"profile_casts\", "
                               "casts = [" +
                               cast(1500.0) + "] } } }\n");
  const Sampler sampler(study);
  std::map<double, int> speeds;
  const std::vector<std::string> labels = sampler.columns()[1].labels;
  EXPECT_EQ(labels, (std::vector<std::string>{"1", "2", "summer: 1"}));
  for (std::uint64_t i = 0; i < 300; ++i) {
    TomlValue tree = study.scenario;
    const Sampler::Drawn row = sampler.draw(i);
    sampler.apply(row, tree);
    const double c = *number_of(
        std::get<TomlValue::Array>(find_at(tree, "environment.sound_speed.speed")->data)[0]);
    ++speeds[c];
    EXPECT_EQ(c == 1500.0, row.values[0] == 1.0);
    EXPECT_EQ(c, row.values[1] == 2.0 ? 1500.0 : row.values[1] == 1.0 ? 1485.0 : 1480.0);
  }
  EXPECT_EQ(speeds.size(), 3U);
}

TEST(DependentLaws, EveryKindOfLawMayStandInABranch) {
  const auto x = drawn(
      study_of(season +
               "\"target.0\" = { given = \"season\", laws = { winter = { law = \"track\", range = "
               "2000.0, depth = 50.0 }, summer = { law = \"track\", radius = 1000.0, depth = 100.0 "
               "} } }\n"
               "\"array.phones\" = { given = \"season\", laws = [ { law = \"categorical\", values "
               "= [2, 4] }, { law = \"grid\", values = [8] } ] }\n"));
  for (std::size_t i = 0; i < n; ++i) {
    const bool winter = x.at("season")[i] == 0.0;
    EXPECT_EQ(x.at("target_0_depth")[i], winter ? 50.0 : 100.0);
    EXPECT_EQ(x.at("phones")[i] == 8.0, !winter);
  }
}

TEST(DependentLaws, FaultsAreTold) {
  const std::string wind = "\"environment.wind_speed\" = ";
  const std::vector<std::pair<std::string, std::string>> faults{
      {wind + "{ law = \"expression\", value = \"2 * strength_db\" }\n\"target.0.strength_db\" = { "
              "law = \"expression\", value = \"wind_speed / 2\" }\n",
       "study.toml:5: vary.wind_speed: found a circle: \"wind_speed\" looks at \"strength_db\" "
       "looks at \"wind_speed\", expected inputs that look at others in one direction only"},
      {season + wind + "{ law = \"expression\", value = \"2 * seson\" }\n",
       "study.toml:6: vary.wind_speed: found the name \"seson\", expected the column of another "
       "input, \"season\" (did you mean \"season\"?)"},
      {season + wind + "{ law = \"expression\", value = \"2 * season\" }\n",
       "study.toml:6: vary.\"environment.wind_speed\".value: found \"season\", which is no number, "
       "expected a formula of numbers; a law for each of \"winter\" or \"summer\" is had by given "
       "= "
       "\"season\""},
      {season + wind +
           "{ given = \"season\", laws = { winter = { law = \"rayleigh\", mean = 5.0 } "
           "} }\n",
       "study.toml:6: vary.\"environment.wind_speed\".laws: found none for it, expected a law for "
       "\"summer\", or one \"otherwise\""},
      {season + wind +
           "{ given = \"season\", laws = { wintr = { law = \"rayleigh\", mean = 5.0 } "
           "} }\n",
       "study.toml:6: vary.\"environment.wind_speed\".laws.wintr: found \"wintr\", expected a "
       "value "
       "of \"season\", \"winter\" or \"summer\", or \"otherwise\""},
      {season + wind + "{ given = \"season\", laws = [ { law = \"rayleigh\", mean = 5.0 } ] }\n",
       "study.toml:6: vary.\"environment.wind_speed\".laws: found an array of 1, expected 2 laws, "
       "for \"winter\" or \"summer\""},
      {season + wind + "{ law = \"rayleigh\", given = \"season\", mean = 5.0 }\n",
       "study.toml:6: vary.\"environment.wind_speed\".law: found \"rayleigh\", expected no \"law\" "
       "beside given: \"laws\" has one for each case"},
      {season + wind +
           "{ given = \"season\", laws = [ { law = \"list\", values = [5.0] }, { law = "
           "\"rayleigh\", mean = 5.0 } ] }\n",
       "study.toml:6: vary.\"environment.wind_speed\".laws[0].law: found \"list\", expected "
       "\"categorical\" or \"grid\": a list goes by the number of the realisation, whichever of "
       "the "
       "laws it takes"},
      {"\"target.0.strength_db\" = { law = \"uniform\", low = 0, high = 1 }\n" + wind +
           "{ given = \"strength_db\", laws = [ { law = \"rayleigh\", mean = 5.0 } ] }\n",
       "study.toml:6: vary.\"environment.wind_speed\".edges: found nothing, expected edges of "
       "intervals: the values of \"strength_db\" cannot be counted"},
      {season +
           "profile = { given = \"season\", keys = [\"environment.wind_speed\"], laws = [ { "
           "law = \"rayleigh\", mean = 5.0 }, { law = \"categorical\", values = [\"a\"] } ] }\n",
       "study.toml:6: vary.profile.laws: found other columns in \"summer\" than in \"winter\", "
       "expected laws that draw the same columns, all numbers or all with labels"}};
  for (const auto& [vary, message] : faults) EXPECT_EQ(fault_of(vary), message) << vary;
}

// A formula that has no value in a realisation is a fault of that realisation.
TEST(DependentLaws, AFormulaWithoutAValueIsAFaultOfItsRow) {
  EXPECT_NE(
      fault_of("\"target.0.strength_db\" = { law = \"expression\", value = \"sqrt(0 - 1)\" }\n")
          .find("of \"sqrt(0 - 1)\" (realisation 0: strength_db ="),
      std::string::npos);
}

const std::string three =
    "\"environment.wind_speed\" = { law = \"rayleigh\", mean = 7.0, max = 20.0 }\n"
    "\"noise.spectral_level_db\" = { law = \"uniform\", low = 30.0, high = 50.0 }\n"
    "\"target.0.strength_db\" = { law = \"log_normal\", median = 5.0, log_deviation = 1.0 }\n";

std::string correlated(const std::string& matrix, const std::string& more = "") {
  return three +
         "[correlation]\ninputs = [\"wind_speed\", \"spectral_level_db\", "
         "\"strength_db\"]\nmatrix = " +
         matrix + "\n" + more;
}

// Spearman's ρ of a Gaussian copula is 6/π·asin(r/2). In n rows its standard deviation is at most
// 1/√n (that of independent ones), and 4.9 of them are passed once in 10⁶.
const std::string windy_months =
    "month = { law = \"uniform\", low = 0.0, high = 12.0, keys = [] }\n"
    "\"environment.wind_speed\" = { law = \"rayleigh\", mean = \"6 + 4*sin(month)\" }\n";

// Given the month a draw's own distribution function is uniform: the mean goes with it without
// steps. With one mean for all months it is not.
TEST(DependentLaws, ParametersMayBeFormulae) {
  for (const char* design : {"random", "sobol"}) {
    const auto x = drawn(study_of(windy_months, design));
    std::vector<double> share, one_mean;
    for (std::size_t i = 0; i < n; ++i) {
      const double wind = x.at("wind_speed")[i], mean = 6.0 + 4.0 * std::sin(x.at("month")[i]);
      share.push_back(1.0 - std::exp(-0.25 * std::numbers::pi * std::pow(wind / mean, 2)));
      one_mean.push_back(1.0 - std::exp(-0.25 * std::numbers::pi * std::pow(wind / 6.0, 2)));
    }
    const auto even = [](double u) { return u; };
    EXPECT_LT(support::kolmogorov_distance(share, even) * std::sqrt(double(n)), 2.69) << design;
    EXPECT_GT(support::kolmogorov_distance(one_mean, even) * std::sqrt(double(n)), 2.69) << design;
  }
}

// Each law by its own parameters, limits too: as the same law with numbers, of the same coordinate.
TEST(DependentLaws, EveryContinuousLawTakesFormulae) {
  const std::vector<std::pair<std::string, std::string>> laws{
      {"law = \"uniform\", low = \"a\", high = 9", "law = \"uniform\", low = 2, high = 9"},
      {"law = \"normal\", mean = 5, deviation = \"a/2\"",
       "law = \"normal\", mean = 5, deviation = 1"},
      {"law = \"log_normal\", median = \"a+3\", log_deviation = 0.3",
       "law = \"log_normal\", median = 5, log_deviation = 0.3"},
      {"law = \"triangular\", low = 1, mode = \"a\", high = \"a*3\"",
       "law = \"triangular\", low = 1, mode = 2, high = 6"},
      {"law = \"rayleigh\", scale = \"a\", max = \"a*2\"",
       "law = \"rayleigh\", scale = 2, max = 4"},
      {"law = \"weibull\", shape = \"a\", mean = 5, min = 1",
       "law = \"weibull\", shape = 2, mean = 5, min = 1"}};
  for (const auto& [formula, number] : laws) {
    const std::string a = "a = { law = \"grid\", values = [2.0], keys = [] }\n";
    const auto x =
        drawn(study_of(a + "\"environment.wind_speed\" = { " + formula + " }\n", "random", 200));
    const auto y =
        drawn(study_of(a + "\"environment.wind_speed\" = { " + number + " }\n", "random", 200));
    EXPECT_EQ(x.at("wind_speed"), y.at("wind_speed")) << formula;
  }
}

// The file has each row's density given its month: weights for another law of the wind. Of the
// month's own Rayleigh law the mean of wind² is 4/π·mean²; weighed for one mean of 2.5 it is
// 4/π·6.25.
TEST(DependentLaws, DensitiesAreStoredAsConditional) {
  const Study study = study_of(windy_months);
  Table table;
  for (const auto& [name, values] : drawn(study)) {
    table.columns.push_back({.name = name});
    table.values.push_back(values);
  }
  table.index.resize(n);
  const std::vector<RowDensity> made = row_densities(study, table);
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].column, "wind_speed");
  const auto rayleigh = [](double x, double mean) {
    const double c = 0.25 * std::numbers::pi / (mean * mean);
    return 2.0 * c * x * std::exp(-c * x * x);
  };
  const auto x = drawn(study);
  double sum = 0.0, weights = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double wind = x.at("wind_speed")[i], mean = 6.0 + 4.0 * std::sin(x.at("month")[i]);
    EXPECT_NEAR(made[0].density[i], rayleigh(wind, mean), 1e-12);
    const double weight = rayleigh(wind, 2.5) / made[0].density[i];
    sum += weight * wind * wind;
    weights += weight;
    squares += std::pow(weight * wind * wind, 2);
  }
  const double truth = 4.0 / std::numbers::pi * 6.25;
  const double error = std::sqrt(squares / n - std::pow(sum / n, 2)) / std::sqrt(double(n));
  EXPECT_NEAR(weights / n, 1.0, 0.15);
  EXPECT_NEAR(sum / n, truth, 4.9 * error);
  // By the mixture's table nobody could weigh a row: it is another density.
  const std::vector<LawTable> tables = law_tables(study);
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables[1].how, "50000 draws of another seed");
}

TEST(DependentLaws, ParametersThatMakeNoLawAreAFaultOfTheirRow) {
  const Study study = study_of(
      "month = { law = \"uniform\", low = 0.0, high = 12.0, keys = [] }\n"
      "\"environment.wind_speed\" = { law = \"rayleigh\", mean = \"8 - month\" }\n");
  const Sampler sampler(study);
  int faults = 0;
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Sampler::Drawn row = sampler.draw(i);
    TomlValue tree = study.scenario;
    try {
      sampler.apply(row, tree);
      EXPECT_LT(row.values[0], 8.0);
    } catch (const InputError& error) {
      ++faults;
      EXPECT_GE(row.values[0], 8.0);
      EXPECT_NE(std::string(error.what())
                    .find("found what makes no law: mean = \"8 - month\", expected "
                          "parameters of a law \"rayleigh\""),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_GT(faults, 5);
  EXPECT_NE(fault_of("\"environment.wind_speed\" = { law = \"rayleigh\", mean = \"mnth\" }\n")
                .find("found the name \"mnth\""),
            std::string::npos);
  EXPECT_NE(
      fault_of("a = { law = \"uniform\", low = 0, high = 1, keys = [] }\n"
               "\"environment.wind_speed\" = { law = \"normal\", mean = \"a\", deviation = -1 }\n")
          .find("deviation: found -1, expected a number above 0"),
      std::string::npos);
}

TEST(Correlation, RanksAreCorrelatedAsTheCopulaSays) {
  const auto spearman = [](double r) { return 6.0 / pi * std::asin(r / 2.0); };
  const std::string matrix = "[[1, 0.7, -0.5], [0.7, 1, 0.1], [-0.5, 0.1, 1]]";
  const double slack = 4.9 / std::sqrt(double(n));
  for (const bool of_ranks : {false, true}) {
    const auto x = drawn(study_of(correlated(matrix, of_ranks ? "of = \"ranks\"\n" : "")));
    const auto w = ranks(x.at("wind_speed")), l = ranks(x.at("spectral_level_db")),
               s = ranks(x.at("strength_db"));
    const auto expected = [&](double r) { return of_ranks ? r : spearman(r); };
    EXPECT_NEAR(correlation(w, l), expected(0.7), slack);
    EXPECT_NEAR(correlation(w, s), expected(-0.5), slack);
    EXPECT_NEAR(correlation(l, s), expected(0.1), slack);
  }
  // Many rows, and Sobol' points: the two readings of 0.7 are 0.017 apart, and both are met.
  for (const bool of_ranks : {false, true}) {
    const auto x =
        drawn(study_of(correlated(matrix, of_ranks ? "of = \"ranks\"\n" : ""), "sobol", 16384));
    const double rho = correlation(ranks(x.at("wind_speed")), ranks(x.at("spectral_level_db")));
    EXPECT_NEAR(rho, of_ranks ? 0.7 : spearman(0.7), 0.004);
    EXPECT_GT(std::abs(rho - (of_ranks ? spearman(0.7) : 0.7)), 0.008);
  }
}

// Enough rows to tell a deviation of the scores that is 8 % too small: that moves Φ by 0.02.
TEST(Correlation, LeavesEachLawAsItIs) {
  constexpr std::uint64_t many = 40000;
  const Study study =
      study_of(correlated("[[1, 0.9, 0.5], [0.9, 1, 0.6], [0.5, 0.6, 1]]"), "random", many);
  const auto x = drawn(study), alone = drawn(study_of(three, "random", many));
  EXPECT_EQ(x.at("wind_speed"), alone.at("wind_speed"));  // the first one, to the bit
  EXPECT_NE(x.at("strength_db"), alone.at("strength_db"));
  for (const Variable& variable : study.variables) {
    const CutLaw& law = std::get<NumberLaw>(variable.law).law;
    const auto own = [&](double v) { return law.distribution(v); };
    EXPECT_LT(distance(x.at(variable.name), own), 2.69) << variable.name;
    const auto other = [&](double v) { return std::pow(law.distribution(v), 1.05); };
    EXPECT_GT(distance(x.at(variable.name), other), 2.69) << variable.name;
  }
}

// Of a law for each season the scores are those of that season's law.
TEST(Correlation, OfConditionalLaws) {
  const auto x = drawn(
      study_of(season +
               "\"environment.wind_speed\" = { given = \"season\", laws = { winter = { law = "
               "\"uniform\", low = 10.0, high = 20.0 }, summer = { law = \"uniform\", low = 0.0, "
               "high = 5.0 } } }\n\"noise.spectral_level_db\" = { law = \"normal\", mean = 40.0, "
               "deviation = 3.0 }\n[correlation]\ninputs = [\"wind_speed\", "
               "\"spectral_level_db\"]\nmatrix = [[1, 0.8], [0.8, 1]]\n"));
  for (const double s : {0.0, 1.0}) {
    const auto w = ranks(where(x.at("wind_speed"), x.at("season"), s)),
               l = ranks(where(x.at("spectral_level_db"), x.at("season"), s));
    EXPECT_NEAR(correlation(w, l), 6.0 / pi * std::asin(0.4), 4.9 / std::sqrt(double(w.size())));
  }
}

TEST(Correlation, FaultsNameTheEntry) {
  const std::string at = "study.toml:10: correlation.";
  const std::vector<std::pair<std::string, std::string>> faults{
      {"[[1, 0.5], [0.5, 1]]",
       at + "matrix: found 2 × 2, expected a row and a column for each of the 3 inputs"},
      {"[[1, 0.5, 0], [0.4, 1, 0], [0, 0, 1]]",
       at + "matrix[1][0]: found 0.4, expected 0.5 as in matrix[0][1]: the correlation of "
            "\"spectral_level_db\" and \"wind_speed\""},
      {"[[1, 0.5, 0], [0.5, 2, 0], [0, 0, 1]]",
       at + "matrix[1][1]: found 2, expected a correlation from -1 to 1"},
      {"[[1, 0.5, 0], [0.5, 0.9, 0], [0, 0, 1]]",
       at + "matrix[1][1]: found 0.9, expected 1, the correlation of \"spectral_level_db\" with "
            "itself"},
      // r₂₃ lies between r₁₂r₁₃ ± √((1 − r₁₂²)(1 − r₁₃²)) = 0.81 ± 0.19.
      {"[[1, 0.9, 0.9], [0.9, 1, 0.5], [0.9, 0.5, 1]]",
       at + "matrix[2][1]: found 0.5, expected a correlation of \"strength_db\" and "
            "\"spectral_level_db\" between 0.62 and 1, or others before it: the matrix is to be "
            "positive definite"}};
  for (const auto& [matrix, message] : faults) EXPECT_EQ(fault_of(correlated(matrix)), message);
  EXPECT_EQ(
      fault_of(three + "[correlation]\ninputs = [\"wind_speed\", \"wind_sped\"]\n"),
      "study.toml:9: correlation.inputs[1]: found \"wind_sped\", expected at least two inputs "
      "of continuous laws, of \"wind_speed\", \"spectral_level_db\" or \"strength_db\" (did "
      "you mean \"wind_speed\"?)");
  EXPECT_EQ(
      fault_of(season + "[correlation]\ninputs = [\"season\"]\n"),
      "study.toml:7: correlation.inputs: found an array of 1, expected at least two inputs of "
      "continuous laws (uniform, normal, weibull, …); of these the study has 0");
}

}  // namespace
}  // namespace asdic::detail::study
