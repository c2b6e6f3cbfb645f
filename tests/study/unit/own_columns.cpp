// Measures that are formulae of a row's columns. Truth: the formulae by hand, and closed forms.
#include "study/summary/own_columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "study/journal/fingerprint.h"
#include "study/reader/study_reader.h"
#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"
#include "support/function_study.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

using support::column_named;
using support::table_named;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

std::string file_of(const std::string& summary) {
  return "[study]\nrealisations = 20\n"
         "[vary]\n\"target.0.depth\" = { law = \"uniform\", low = 20.0, high = 80.0 }\n"
         "\"pulse.window\" = { law = \"categorical\", values = [\"hann\", \"none\"] }\n"
         "[measure]\necho_level = true\nnoise_level = true\n[summary]\n" +
         summary + support::plain_sea;
}

Study study_of(const std::string& summary) {
  const support::TemporaryDirectory folder;
  return read_study(folder.write("study.toml", file_of(summary)));
}

std::string fault_of(const std::string& own) {
  try {
    static_cast<void>(study_of("[summary.own]\n" + own));
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("study.toml"));
  }
  return "no fault";
}

/// Rows: depth, window, echo_level_db, noise_level_db.
Table rows_of(const Study& study, const std::vector<std::vector<double>>& rows) {
  Table table{.columns = columns(study)};
  table.values.resize(table.columns.size());
  for (const std::vector<double>& row : rows) {
    table.index.push_back(table.index.size());
    table.valid.push_back(1);
    for (std::size_t c = 0; c < row.size(); ++c) table.values[c].push_back(row[c]);
  }
  return table;
}

TEST(OwnColumns, AreTheirFormulae) {
  // `twice` stands before what it looks at.
  const Study study = study_of(R"toml([summary.own]
twice = "2 * margin"
margin = { value = "echo_level_db - noise_level_db - 12", unit = "dB" }
loud = { value = "echo_level_db > 80 && depth < 50", event = true }
loud_or_unknown = { value = "echo_level_db > 80", event = true, otherwise = 1 }
shifted = { value = "margin / (depth - 30)", otherwise = -1 }
)toml");
  const std::vector<Column> own = own_columns(study);
  ASSERT_EQ(own.size(), 5U);
  EXPECT_EQ(own.back().name, "twice");  // after what it looks at
  EXPECT_EQ(own.back().unit, "1");
  Table rows = rows_of(study, {{40, 0, 90, 60},
                               {60, 0, 90, 60},
                               {40, 1, nan, 60},
                               {40, 1, -infinite, 60},
                               {30, 0, 72, 60},
                               {40, 0, 90, 60}});
  rows.valid[5] = 0;
  const Table made = OwnValues(study).of(rows);
  const auto column = [&](const std::string& name) {
    for (std::size_t i = 0; i < made.columns.size(); ++i)
      if (made.columns[i].name == name) return made.values[i];
    throw std::runtime_error(name);
  };
  const auto expect = [&](const std::string& name, const std::vector<double>& truth) {
    const ColumnValues found = column(name);
    ASSERT_EQ(found.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i)
      EXPECT_TRUE(found[i] == truth[i] || (std::isnan(found[i]) && std::isnan(truth[i])))
          << name << ' ' << i << ' ' << found[i];
  };
  expect("margin", {18, 18, nan, -infinite, 0, nan});
  expect("twice", {36, 36, nan, -infinite, 0, nan});
  // What is not known is not "quieter than 80 dB"; −∞ is.
  expect("loud", {1, 0, nan, 0, 0, nan});
  expect("loud_or_unknown", {1, 1, 1, 0, 0, nan});
  expect("shifted", {1.8, 0.6, -1, -infinite, nan, nan});  // 0/0 is no number of what is known
}

TEST(OwnColumns, AreInEveryTable) {
  const Study study = study_of(R"toml(by = ["depth", "margin"]
[summary.own]
margin = { value = "echo_level_db - noise_level_db", unit = "dB" }
loud = { value = "margin > 10", event = true }
)toml");
  std::vector<std::vector<double>> rows;
  for (int i = 0; i < 400; ++i) rows.push_back({20.0 + 0.15 * i, double(i % 2), 60.0 + i % 20, 55});
  const Summary made = summary_of(study, rows_of(study, rows));
  ASSERT_EQ(made.own.columns.size(), 2U);
  const SummaryTable& statistics = table_named(made.tables, "statistics");
  ASSERT_EQ(statistics.columns[0].labels.back(), "loud");
  // margin is 5 … 24, above 10 in 14 of 20: an event has Wilson's interval, not a mean's.
  const Interval truth = wilson(280, 400, 0.95);
  EXPECT_NEAR(column_named(statistics, "mean").back(), 0.7, 1e-12);
  EXPECT_NEAR(column_named(statistics, "mean_low").back(), truth.low, 1e-12);
  EXPECT_NEAR(column_named(statistics, "mean_high").back(), truth.high, 1e-12);
  const SummaryTable& by = table_named(made.tables, "p_loud_by_depth");
  EXPECT_EQ(column_named(by, "p_loud_low").size(), 10U);
  EXPECT_NEAR(column_named(by, "p_loud")[3], 0.7, 1e-12);
  EXPECT_NO_THROW(column_named(table_named(made.tables, "means_by_depth"), "margin_low"));
  const auto along_margin = column_named(table_named(made.tables, "p_loud_by_margin"), "p_loud");
  for (const double p : along_margin) EXPECT_TRUE(p == 0.0 || p == 1.0 || p == 0.5) << p;
  EXPECT_EQ(table_named(made.tables, "convergence").columns[1].name, "p_loud");
  std::vector<std::string> measures;
  for (const SummaryTable& table : made.tables)
    if (table.name == "sensitivity") measures = table.columns[0].labels;
  EXPECT_NE(std::find(measures.begin(), measures.end(), "margin"), measures.end());
}

// The identity is of the rows, and they do not change.
TEST(OwnColumns, ChangeNoRow) {
  const Study without = study_of(""), with = study_of("[summary.own]\nx = \"depth / 2\"\n");
  EXPECT_EQ(identity(without), identity(with));
  EXPECT_EQ(to_json(fingerprint_of(without).columns), to_json(fingerprint_of(with).columns));
}

TEST(OwnColumns, FaultsSayWhatIsWrong) {
  EXPECT_NE(fault_of("x = \"dept / 2\"").find("the name \"dept\", expected one of \"depth\""),
            std::string::npos)
      << fault_of("x = \"dept / 2\"");
  EXPECT_NE(fault_of("x = \"dept / 2\"").find("did you mean \"depth\"?"), std::string::npos);
  EXPECT_NE(fault_of("x = \"window + 1\"").find("\"window\", which is no number"),
            std::string::npos);
  EXPECT_NE(fault_of("x = \"y\"\ny = \"x\"").find("waits for one that waits for it"),
            std::string::npos);
  EXPECT_NE(fault_of("x = \"x + 1\"").find("looks at itself"), std::string::npos);
  EXPECT_NE(fault_of("depth = \"1\"").find("a name that no column of the rows has"),
            std::string::npos);
  EXPECT_NE(fault_of("\"X y\" = \"1\"").find("a name of small letters"), std::string::npos);
  EXPECT_NE(fault_of("x = { value = \"depth\", event = true, unit = \"m\" }").find("no unit of an"),
            std::string::npos);
  EXPECT_NE(fault_of("x = { value = \"depth\", event = true, otherwise = 2 }").find("0 or 1"),
            std::string::npos);
  EXPECT_NE(fault_of("x = { valu = \"depth\" }").find("value"), std::string::npos)
      << fault_of("x = { valu = \"depth\" }");
  EXPECT_NE(fault_of("x = \"depth = 3\"").find("== to compare"), std::string::npos);
}

}  // namespace
}  // namespace asdic::detail::study
