#include <gtest/gtest.h>

#include "io/scenario/scenario_reader.h"
#include "study/measures/measures.h"
#include "study/reader/study_reader.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// The example of docs/develop/recipes.md: a new measure.

namespace asdic::detail::study {
namespace {

/// The example of a level out of the summary: a range by the echo's time.
struct EchoRange {
  static constexpr std::string_view name = "echo_range", column = "echo_range", unit = "m",
                                    meaning = "half of the echo's time at 1500 m/s";
  static double of(const TargetSummary& target) { return 750.0 * target.echo_time; }
};

/// The example of one that looks at the ping itself.
struct Echoes {
  static constexpr std::string_view name = "echoes";
  static constexpr Needs needs{.targets = true};
  static void of_ping(const MeasuredPing& ping, Collector& to) {
    to.add("echoes", "1", "pairs of paths of all targets",
           ping ? static_cast<double>(ping.record->echoes.size()) : no_value);
  }
};

TEST(Recipe, AMeasureIsAFileAndAWord) {
  support::TemporaryDirectory folder;
  Study study = read_study(
      folder.write("study.toml", "[study]\nrealisations = 1\n[measure]\necho_time = true\n" +
                                     std::string(support::plain_sea)));
  study.measure.wanted = {"echo_time", "echo_range", "echoes"};
  constexpr auto& measures = measure_list<EchoTime, EchoRange, Echoes, SeriesLevel>;
  const Scenario scenario = scenario_of(study.scenario, study.scenario_path);
  const std::vector<Column> columns = measure_columns(study, scenario, measures);
  ASSERT_EQ(columns.size(), 3U);  // of those that are wanted
  EXPECT_EQ(columns[1].name, "echo_range");
  EXPECT_EQ(columns[1].unit, "m");
  EXPECT_EQ(columns[2].name, "echoes");
  const Measured made = measure(study, PingSimulator(scenario), measures);
  ASSERT_EQ(made.values.size(), 3U);
  EXPECT_EQ(made.values[1], 750.0 * made.values[0]);
  EXPECT_EQ(made.values[2], static_cast<double>(made.record.echoes.size()));
}

}  // namespace
}  // namespace asdic::detail::study
