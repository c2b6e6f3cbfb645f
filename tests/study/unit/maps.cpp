#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/error.h"
#include "study/reader/study_reader.h"
#include "study/sampling/design.h"
#include "study/summary/clustered_mean.h"
#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"
#include "support/function_study.h"
#include "support/mixture.h"
#include "support/plain_sea.h"
#include "support/summary_tables.h"
#include "support/temporary_directory.h"

// [summary.map]: cells of place and depth.

namespace asdic::detail::study {
namespace {

/// Range even in area to 10 km, any bearing, depth to 100 m; detected with probability 0.8 east of
/// the array and 0.2 west of it; a level of minus the range, none in every fifth row.
Table disc(std::uint64_t seed, std::size_t rows) {
  Table table;
  const auto input = Column::Role::input, measure = Column::Role::measure;
  table.columns = {{.name = "range", .unit = "m", .role = input},
                   {.name = "bearing_deg", .unit = "degrees", .role = input},
                   {.name = "depth", .unit = "m", .role = input},
                   {.name = "detected", .unit = "1", .role = measure},
                   {.name = "echo_level_db", .unit = "dB", .role = measure}};
  table.values.resize(table.columns.size());
  for (std::size_t i = 0; i < rows; ++i) {
    const auto u = [&](std::uint32_t d) { return uniform_draw(seed, i, d); };
    const double range = 10e3 * std::sqrt(u(0)), bearing = 360.0 * u(1);
    table.index.push_back(i);
    table.valid.push_back(1);
    table.values[0].push_back(range);
    table.values[1].push_back(bearing);
    table.values[2].push_back(100.0 * u(2));
    table.values[3].push_back(u(3) < (bearing < 180.0 ? 0.8 : 0.2) ? 1.0 : 0.0);
    table.values[4].push_back(i % 5 == 0 ? -infinity : -range);
  }
  return table;
}

Study of_place(std::optional<SummaryAxis> depth = {}) {
  Study study;
  const std::vector<double> edges{-10e3, -5e3, 0.0, 5e3, 10e3};
  study.summary.map = SummaryMap{.across = {.column = "east", .edges = edges},
                                 .up = {.column = "north", .edges = edges},
                                 .range = "range",
                                 .bearing = "bearing_deg",
                                 .depth = std::move(depth)};
  return study;
}

TEST(Map, EachRowIsWhereItsRangeAndBearingPutIt) {
  const Table rows = disc(3, 4000);
  const auto tables =
      summarise(of_place(SummaryAxis{.column = "depth", .edges = {0.0, 30.0, 100.0}}), rows);
  const SummaryTable& t = named(tables, "map_pd");
  ASSERT_EQ(t.axes, (std::vector<std::string>{"depth", "east", "north"}));
  ASSERT_EQ(column(t, "count").size(), 2U * 4U * 4U);
  for (std::size_t cell = 0; cell < 32; ++cell) {
    // Brute force, from north clockwise.
    double count = 0.0, hits = 0.0;
    for (std::size_t row = 0; row < 4000; ++row) {
      const double b = rows.values[1][row] * std::numbers::pi / 180.0;
      const double x = rows.values[0][row] * std::sin(b), y = rows.values[0][row] * std::cos(b);
      const auto in = [&](const char* axis, double at) {
        return at >= column(t, std::string(axis) + "_low")[cell] &&
               at < column(t, std::string(axis) + "_high")[cell];
      };
      if (!in("east", x) || !in("north", y) || !in("depth", rows.values[2][row])) continue;
      count += 1.0;
      hits += rows.values[3][row];
    }
    EXPECT_EQ(column(t, "count")[cell], count);
    EXPECT_EQ(column(t, "hits")[cell], hits);
    const Interval interval = wilson(hits, count, 0.95);
    EXPECT_NEAR(column(t, "pd_low")[cell], interval.low, 1e-12);
  }
}

TEST(Map, IntervalsOfCellsHoldTheTruth) {
  // 40 maps of 16 cells: 0.8 in the east, 0.2 in the west; 95 % of 640, five deviations. Where
  // bearings were taken from east, counterclockwise, half of the cells would be wrong.
  int held = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto tables = summarise(of_place(), disc(seed, 3000));
    const SummaryTable& t = named(tables, "map_pd");
    for (std::size_t cell = 0; cell < 16; ++cell) {
      const auto holds = [&](double truth) {
        return column(t, "pd_low")[cell] <= truth && truth <= column(t, "pd_high")[cell] ? 1 : 0;
      };
      held += holds(column(t, "east")[cell] > 0.0 ? 0.8 : 0.2);
      wrong += holds(column(t, "north")[cell] > 0.0 ? 0.8 : 0.2);
    }
  }
  EXPECT_NEAR(held, 608, 28);
  EXPECT_LT(wrong, 400);
}

TEST(Map, CellsWithoutRowsAreThereAndSayNothing) {
  const auto tables = summarise(of_place(), disc(1, 12));
  const SummaryTable& t = named(tables, "map_pd");
  int empty = 0;
  for (std::size_t cell = 0; cell < 16; ++cell)
    if (column(t, "count")[cell] == 0.0) {
      ++empty;
      EXPECT_TRUE(std::isnan(column(t, "pd")[cell]));
      EXPECT_EQ(column(t, "pd_high")[cell], 1.0);
    }
  EXPECT_GE(empty, 4);
}

TEST(Map, MeansAreOfWhatIsFiniteAndQuantilesOfAll) {
  Study study;
  study.summary.quantiles = {0.1, 0.6};
  study.summary.map = SummaryMap{.polar = true,
                                 .across = {.column = "range", .edges = {0.0, 10e3}},
                                 .up = {.column = "bearing_deg", .edges = {0.0, 360.0}}};
  const auto tables = summarise(study, disc(5, 20'000));
  const SummaryTable& t = named(tables, "map_means");
  EXPECT_EQ(column(t, "count")[0], 20'000.0);
  EXPECT_EQ(column(t, "echo_level_db_count")[0], 16'000.0);
  // Mean range of a disc 2R/3; a fifth has no level, so that quantile 0.6 is at half of the rest:
  // −R/√2. Five standard deviations.
  EXPECT_NEAR(column(t, "echo_level_db")[0], -2.0 / 3.0 * 10e3, 100.0);
  EXPECT_NEAR(column(t, "echo_level_db_q0600")[0], -10e3 / std::numbers::sqrt2, 200.0);
  EXPECT_EQ(column(t, "echo_level_db_q0100")[0], -infinity);
}

/// The same rows with weights. \param log_weight  of a row
template <class LogWeight>
Table weighed(Table table, LogWeight log_weight) {
  table.columns.push_back({.name = log_weight_column, .unit = "1", .role = Column::Role::weight});
  table.values.emplace_back();
  for (std::size_t row = 0; row < table.index.size(); ++row)
    table.values.back().push_back(log_weight(row));
  return table;
}

TEST(WeightedMap, CellsAreSumsOfWeights) {
  Study study = of_place();
  study.summary.quantiles = {0.3, 0.7};
  const Table rows =
      weighed(disc(7, 3000), [](std::size_t row) { return -6.0 * uniform_draw(11, row, 0); });
  const auto tables = map_tables(study, rows);
  const SummaryTable &pd = named(tables, "map_pd"), &means = named(tables, "map_means");
  for (std::size_t cell = 0; cell < 16; ++cell) {
    // Brute force.
    double n = 0.0, w_all = 0.0, w_level = 0.0, level = 0.0;
    std::array<double, 2> sum{}, squares{}, largest{};
    std::vector<std::pair<double, double>> levels;
    for (std::size_t row = 0; row < 3000; ++row) {
      const double b = rows.values[1][row] * std::numbers::pi / 180.0;
      const double x = rows.values[0][row] * std::sin(b), y = rows.values[0][row] * std::cos(b);
      if (x < column(pd, "east_low")[cell] || x >= column(pd, "east_high")[cell] ||
          y < column(pd, "north_low")[cell] || y >= column(pd, "north_high")[cell])
        continue;
      const double w = std::exp(rows.values.back()[row]), at = rows.values[4][row];
      const auto which = static_cast<std::size_t>(rows.values[3][row]);
      n += 1.0;
      w_all += w;
      sum.at(which) += w;
      squares.at(which) += w * w;
      largest.at(which) = std::max(largest.at(which), w);
      levels.emplace_back(at, w);
      if (!std::isfinite(at)) continue;
      w_level += w;
      level += w * at;
    }
    const std::size_t rarer = sum[0] < sum[1] ? 0 : 1;
    EXPECT_EQ(column(pd, "count")[cell], n);
    EXPECT_NEAR(column(pd, "pd")[cell], sum[1] / w_all, 1e-12);
    EXPECT_NEAR(column(pd, "effective")[cell], sum.at(rarer) * sum.at(rarer) / squares.at(rarer),
                1e-9 * n);
    EXPECT_NEAR(column(pd, "largest_share")[cell], largest.at(rarer) / sum.at(rarer), 1e-12);
    EXPECT_NEAR(column(means, "echo_level_db")[cell], level / w_level, 1e-8);
    std::sort(levels.begin(), levels.end());
    for (const double p : {0.3, 0.7}) {
      double before = 0.0;
      const auto at = std::find_if(levels.begin(), levels.end(), [&](const auto& one) {
        return (before += one.second) >= p * w_all;
      });
      EXPECT_EQ(column(means, p < 0.5 ? "echo_level_db_q0300" : "echo_level_db_q0700")[cell],
                at->first);
    }
  }
}

// Where all weights are alike, whatever they are, the tables are those without weights. Intervals
// of means are Student's then, not normal ones.
TEST(WeightedMap, WithAllWeightsAlikeItIsAMapWithoutThem) {
  const Table rows = disc(8, 2000);
  const auto plain = map_tables(of_place(), rows);
  for (const double log_weight : {0.0, -3.0}) {
    const auto with =
        map_tables(of_place(), weighed(rows, [&](std::size_t) { return log_weight; }));
    ASSERT_EQ(with.size(), plain.size());
    const SummaryTable &a = named(plain, "map_pd"), &b = named(with, "map_pd");
    const SummaryTable &c = named(plain, "map_means"), &d = named(with, "map_means");
    EXPECT_EQ(column(a, "count"), column(b, "count"));
    EXPECT_EQ(column(a, "hits"), column(b, "hits"));
    for (std::size_t cell = 0; cell < 16; ++cell) {
      const double n = column(a, "count")[cell], hits = column(a, "hits")[cell];
      EXPECT_NEAR(column(b, "pd")[cell], hits / n, 1e-12);
      EXPECT_NEAR(column(b, "effective")[cell], std::min(hits, n - hits), 1e-9);
      EXPECT_NEAR(column(b, "largest_share")[cell], 1.0 / std::min(hits, n - hits), 1e-12);
      EXPECT_NEAR(column(c, "echo_level_db")[cell], column(d, "echo_level_db")[cell], 1e-8);
      const double known = column(d, "echo_level_db_count")[cell];
      EXPECT_EQ(column(c, "echo_level_db_count")[cell], known);
      const auto width = [&](const SummaryTable& t) {
        return column(t, "echo_level_db_high")[cell] - column(t, "echo_level_db_low")[cell];
      };
      EXPECT_NEAR(width(d) / width(c), student(0.95, known - 1.0) / two_sided(0.95), 1e-8);
    }
  }
}

TEST(WeightedMap, CellsWithoutRowsSayNothing) {
  const auto tables = map_tables(of_place(), weighed(disc(1, 12), [](std::size_t) { return 0.0; }));
  const SummaryTable &pd = named(tables, "map_pd"), &means = named(tables, "map_means");
  int empty = 0;
  for (std::size_t cell = 0; cell < 16; ++cell) {
    if (column(pd, "count")[cell] > 0.0) continue;
    ++empty;
    EXPECT_TRUE(std::isnan(column(pd, "pd")[cell]));
    EXPECT_EQ(column(pd, "pd_low")[cell], 0.0);
    EXPECT_EQ(column(pd, "pd_high")[cell], 1.0);
    EXPECT_EQ(column(pd, "effective")[cell], 0.0);
    for (const char* name : {"echo_level_db", "echo_level_db_low", "echo_level_db_q0500"})
      EXPECT_TRUE(std::isnan(column(means, name)[cell])) << name;
  }
  EXPECT_GE(empty, 4);
}

/// East and north even over a square, z normal; drawn farther east and beyond z = 3.
support::FunctionStudy drawn_elsewhere() {
  support::FunctionStudy made;
  made.study.realisations = 1500;
  made.study.variables = {support::FunctionStudy::uniform("east", -1.0, 1.0),
                          support::FunctionStudy::uniform("north", -1.0, 1.0),
                          support::normal_input("z")};
  made.study.proposal =
      support::mixture({{ScoreLaw{0.8, 1.0}, std::monostate{}, ScoreLaw{3.2, 1.0}}});
  const std::vector<double> edges{-1.0, 0.0, 1.0};
  made.study.summary.map = SummaryMap{.across = {.column = "east", .edges = edges},
                                      .up = {.column = "north", .edges = edges}};
  return made;
}

double upper_tail(double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2); }
double normal_density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}

// z > 3.2 + e/2 at e east. Of a cell from a to b the truth is the mean of Q(3.2 + e/2), and the
// integral of Q is xQ(x) − φ(x): 1.8e-3 in the west, 3.5e-4 in the east.
TEST(WeightedMap, PdOfEachCellIsThatOfTheLaws) {
  support::FunctionStudy made = drawn_elsewhere();
  made.measure = "detected";
  made.of = [](std::span<const double> x, double) { return x[2] > 3.2 + 0.5 * x[0] ? 1.0 : 0.0; };
  const auto integral = [](double x) { return x * upper_tail(x) - normal_density(x); };
  const std::array<double, 2> truth{(integral(3.2) - integral(2.7)) / 0.5,
                                    (integral(3.7) - integral(3.2)) / 0.5};
  std::array<support::Coverage, 2> right, without, over_all;  // west and east
  std::array<int, 2> narrow{};
  for (std::uint64_t seed = 1; seed <= 80; ++seed) {
    made.study.seed = seed;
    Table rows = made.table();
    const auto tables = map_tables(made.study, rows);
    const SummaryTable& t = named(tables, "map_pd");
    // Wrong: no weights; and sums of weights over the rows of the cell instead of over theirs.
    const std::vector<double> weights = weights_of(rows);
    for (Column& one : rows.columns)
      if (one.name == log_weight_column) one.name = "something";
    const auto unweighted = map_tables(made.study, rows);
    const SummaryTable& u = named(unweighted, "map_pd");
    double weight = 0.0;
    for (const double w : weights) weight += w;
    for (std::size_t cell = 0; cell < 4; ++cell) {
      const double p = column(t, "pd")[cell], low = column(t, "pd_low")[cell],
                   high = column(t, "pd_high")[cell];
      right.at(cell / 2).add(p, low, high, truth.at(cell / 2));
      narrow.at(cell / 2) += high < 3.0 * truth.at(cell / 2);
      without.at(cell / 2).add(column(u, "pd")[cell], column(u, "pd_low")[cell],
                               column(u, "pd_high")[cell], truth.at(cell / 2));
      double of_cell = 0.0;
      for (std::size_t row = 0; row < rows.index.size(); ++row)
        if ((rows.values[0][row] < 0.0) == (cell < 2) &&
            (rows.values[1][row] < 0.0) == (cell % 2 == 0))
          of_cell += weights[row];
      const double factor = of_cell / column(t, "count")[cell];
      over_all.at(cell / 2).add(p * factor, low * factor, high * factor, truth.at(cell / 2));
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const support::Coverage& c = right.at(side);
    EXPECT_GE(c.held, c.least()) << side;
    EXPECT_NEAR(c.mean(), truth.at(side), 5.0 * c.deviation() / std::sqrt(double(c.count)));
    EXPECT_GT(narrow.at(side), c.count / 2) << side;  // the others say that their rows are few
    EXPECT_LT(without.at(side).held, c.count / 10) << side;
    EXPECT_LT(over_all.at(side).held, c.least()) << side;
    std::cout << "held " << c.held << ", without weights " << without.at(side).held
              << ", over all rows " << over_all.at(side).held << " of " << c.count << ", narrow "
              << narrow.at(side) << "; truth " << truth.at(side) << ", mean " << c.mean() << '\n';
  }
}

// A level of z + 2e, none where z < −1: of what is finite the mean is φ(1)/Φ(1) and twice the
// cell's middle; of e = 0 the quantile at Φ(−1) and less would be −∞. The median of z is 0.
TEST(WeightedMap, MeansAndQuantilesOfEachCellAreThoseOfTheLaws) {
  support::FunctionStudy made = drawn_elsewhere();
  made.study.proposal =
      support::mixture({{ScoreLaw{0.8, 1.0}, std::monostate{}, ScoreLaw{1.0, 1.0}}});
  made.study.summary.quantiles = {0.02, 0.5};
  made.of = [](std::span<const double> x, double) { return x[2] < -1.0 ? -infinity : x[2]; };
  const double truth = normal_density(1.0) / (1.0 - upper_tail(1.0));
  support::Coverage mean, median;
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    made.study.seed = seed;
    Table rows = made.table();
    const auto tables = map_tables(made.study, rows);
    const SummaryTable& t = named(tables, "map_means");
    for (Column& one : rows.columns)
      if (one.name == log_weight_column) one.name = "something";
    const auto unweighted = map_tables(made.study, rows);
    const SummaryTable& u = named(unweighted, "map_means");
    for (std::size_t cell = 0; cell < 4; ++cell) {
      mean.add(column(t, "level_db")[cell], column(t, "level_db_low")[cell],
               column(t, "level_db_high")[cell], truth);
      median.add(column(t, "level_db_q0500")[cell], 0.0, 0.0, 0.0);
      EXPECT_EQ(column(t, "level_db_q0020")[cell], -infinity);
      wrong +=
          column(u, "level_db_low")[cell] <= truth && truth <= column(u, "level_db_high")[cell];
    }
  }
  EXPECT_GE(mean.held, mean.least());
  EXPECT_NEAR(mean.mean(), truth, 5.0 * mean.deviation() / std::sqrt(240.0));
  // The least value with half of the weights at or below it lies half a row above the median.
  EXPECT_NEAR(median.mean(), 0.0, 5.0 * median.deviation() / std::sqrt(240.0) + 0.01);
  EXPECT_LT(wrong, 24);
  std::cout << "held " << mean.held << ", without weights " << wrong << " of " << mean.count
            << '\n';
}

/// The plan of a study with a track, or the message that refuses it.
struct Read {
  std::optional<SummaryMap> map{};
  std::string message{};
};
Read read_map(const std::string& map, const std::string& vary, const std::string& measure = "") {
  const support::TemporaryDirectory folder;
  try {
    return {.map = read_study(
                       folder.write("study.toml", "[study]\nrealisations = 2\n[vary]\n" + vary +
                                                      "\n[measure]\necho_level = true\n" + measure +
                                                      "\n[summary]\n" + map + support::plain_sea))
                       .summary.map};
  } catch (const InputError& error) {
    return {.message = error.what()};
  }
}

TEST(MapReader, FindsTheColumnsOfATrack) {
  const std::string track =
      "\"target.0\" = { law = \"track\", radius = 5e3, depth = [10.0, 90.0] }";
  const Read by_track = read_map("map = true\n", track);
  ASSERT_TRUE(by_track.map) << by_track.message;
  EXPECT_EQ(by_track.map->range, "target_0_range");
  EXPECT_EQ(by_track.map->bearing, "target_0_bearing_deg");
  EXPECT_FALSE(by_track.map->depth);
  const Read with_depth = read_map("map = { depth = { bins = 3 }, east = { bins = 7 } }\n", track);
  ASSERT_TRUE(with_depth.map) << with_depth.message;
  EXPECT_EQ(with_depth.map->depth->column, "target_0_depth");
  EXPECT_EQ(with_depth.map->across.bins, 7);
  const Read measured =
      read_map("map = { cells = \"range_bearing\" }\n", track, "target_place = true\n");
  ASSERT_TRUE(measured.map) << measured.message;
  EXPECT_EQ(measured.map->across.column, "place_range");
  EXPECT_EQ(measured.map->up.column, "place_bearing_deg");
}

TEST(MapReader, SaysWhatItMisses) {
  const auto holds = [](const Read& read, const std::string& part) {
    return read.message.find(part) != std::string::npos;
  };
  const std::string range = "\"target.0.range\" = { law = \"uniform\", low = 1e3, high = 4e3 }";
  EXPECT_TRUE(holds(read_map("map = true\n", range), "measure.target_place = true"));
  EXPECT_TRUE(holds(read_map("map = { cells = \"hexagons\" }\n", range), "east_north"));
  EXPECT_TRUE(holds(read_map("map = { east = { axis = \"rnage\" } }\n", range), "range"));
  EXPECT_TRUE(holds(read_map("map = { cells = \"range_bearing\", east = { bins = 3 } }\n", range,
                             "target_place = true\n"),
                    "none beside these cells"));
}

TEST(TargetPlace, IsWhereTheArrayHasIt) {
  const support::TemporaryDirectory folder;
  const Study study = read_study(folder.write(
      "study.toml",
      "[study]\nrealisations = 1\n[set]\n\"target.0.position\" = [-300.0, 400.0, 60.0]\n"
      "\"platform.position\" = [0.0, 0.0, 20.0]\n[measure]\ntarget_place = true\n" +
          std::string(support::plain_sea)));
  const Row row = Realiser(study).realise(0);
  const std::vector<Column> all = columns(study);
  ASSERT_EQ(all.size(), 5U);
  // The first of two phones half a spacing from the platform: within a metre.
  EXPECT_NEAR(row.values[0], -300.0, 1.0);
  EXPECT_NEAR(row.values[1], 400.0, 1.0);
  EXPECT_NEAR(row.values[2], 500.0, 1.0);
  EXPECT_NEAR(row.values[3], 360.0 - std::atan2(300.0, 400.0) * 180.0 / std::numbers::pi, 0.2);
  EXPECT_EQ(row.values[4], 60.0);
}

}  // namespace
}  // namespace asdic::detail::study
