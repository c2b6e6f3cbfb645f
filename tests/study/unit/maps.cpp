#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "study/reader/study_reader.h"
#include "study/sampling/design.h"
#include "study/summary/intervals.h"
#include "study/summary/summary.h"
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
