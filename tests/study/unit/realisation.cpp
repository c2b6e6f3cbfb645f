#include "study/measures/realisation.h"

#include <gtest/gtest.h>

#include "core/units.h"
#include "study/reader/study_reader.h"
#include "study/summary/summary.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

const std::filesystem::path known_answer =
    std::filesystem::path(ASDIC_SCENARIOS) / "studies/known_answer.toml";

Study study_of(const support::TemporaryDirectory& folder, const std::string& tables) {
  return read_study(folder.write("study.toml", tables + support::plain_sea));
}

TEST(Realisation, EchoLevelIsTheSonarEquationAtTheDrawnRange) {
  const support::TemporaryDirectory folder;
  const Study study = study_of(folder,
                               "[study]\nrealisations = 10\n[vary]\n"
                               "\"target.0.range\" = { law = \"uniform\", low = 1e3, high "
                               "= 5e3 }\n[measure]\necho_level = true\n");
  const std::vector<Column> all = columns(study);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "range");
  EXPECT_EQ(all[0].role, Column::Role::input);
  EXPECT_EQ(all[1].name, "echo_level_db");
  const Realiser realiser(study);
  for (std::uint64_t index = 0; index < 5; ++index) {
    const Row row = realiser.realise(index);
    ASSERT_EQ(row.values.size(), all.size());
    const double range = row.values[0];
    EXPECT_GE(range, 1e3);
    EXPECT_LE(range, 5e3);
    // RL = SL − 2·20 lg r + TS, one straight path, less Thorp's loss (0.07 dB/km at 1 kHz, both
    // ways at most 0.7 dB).
    const double level = 200.0 - 40.0 * std::log10(range) + 10.0;
    EXPECT_LT(row.values[1], level + 1e-6);
    EXPECT_GT(row.values[1], level - 0.7);
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
}  // namespace asdic::detail::study
