#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/measures/realisation.h"
#include "study/reader/study_reader.h"
#include "study/summary/summary.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

// A warning is given if the receiver's mean number of false alarms per ping is certainly above that
// of even noise. 60 rows of 12 ± 1, and of 1 ± 1.
TEST(ReceiverAlarms, FalseAlarmsThatNoiseDoesNotMakeAreWarnedOf) {
  const support::TemporaryDirectory folder;
  const Study study = read_study(folder.write(
      "study.toml", std::string("[study]\nrealisations = 60\n[measure]\ndetection = { "
                                "by = \"receiver\", false_alarm_probability = 1e-5 }\n") +
                        support::plain_sea));
  const auto warnings_of = [&](double alarms, double of_noise) {
    Table table{.columns = columns(study), .index = {}, .valid = {}, .values = {}};
    table.values.resize(table.columns.size());
    for (std::uint64_t row = 0; row < 60; ++row) {
      table.index.push_back(row);
      table.valid.push_back(1);
      for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const double here = row % 2 == 0 ? alarms - 1.0 : alarms + 1.0;
        const std::string& name = table.columns[c].name;
        table.values[c].push_back(name == "false_alarms"            ? here
                                  : name == "false_alarms_of_noise" ? of_noise
                                                                    : 0.0);
      }
    }
    return summary_of(study, table).warnings;
  };
  EXPECT_THAT(warnings_of(12.0, 0.88),
              testing::ElementsAre(testing::HasSubstr(
                  "false alarms: the receiver makes 12 a ping (11.7 to 12.3), even noise at most "
                  "0.88")));
  EXPECT_THAT(warnings_of(1.0, 0.88), testing::IsEmpty());
}

}  // namespace
}  // namespace asdic::detail::study
