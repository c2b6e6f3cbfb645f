#include "study/realisation.h"

#include <gtest/gtest.h>

#include "core/units.h"
#include "study/summary.h"

namespace asdic::study {
namespace {

const std::filesystem::path known_answer =
    std::filesystem::path(ASDIC_SCENARIOS) / "studies/known_answer.toml";

TEST(Realisation, EchoLevelIsTheSonarEquationAtTheDrawnRange) {
  // No fluctuation: RL = SL − 2·20 lg r + TS, one straight path.
  const Study study =
      read_study(known_answer, std::vector<std::string>{"target.0.fluctuation=none"});
  const std::vector<Column> all = columns(study);
  ASSERT_GE(all.size(), 2U);
  EXPECT_EQ(all[0].name, "range");
  EXPECT_EQ(all[0].role, Column::Role::input);
  const Realiser realiser(study);
  for (std::uint64_t index = 0; index < 5; ++index) {
    const Row row = realiser.realise(index);
    ASSERT_EQ(row.values.size(), all.size());
    const double range = row.values[0];
    EXPECT_GE(range, 20e3);
    EXPECT_LE(range, 40e3);
    EXPECT_NEAR(row.values[1], 200.0 - 40.0 * std::log10(range) + 30.0, 1e-6);
  }
}

TEST(Realisation, IsAFunctionOfStudyAndIndexAlone) {
  const Study study = read_study(known_answer);
  const Realiser a(study), b(study);
  const Row first = a.realise(3);
  static_cast<void>(b.realise(11));
  EXPECT_EQ(first.values, b.realise(3).values);
  EXPECT_NE(first.values, b.realise(4).values);
}

}  // namespace
}  // namespace asdic::study
