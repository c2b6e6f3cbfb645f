#include "study/summary/until.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/error.h"
#include "study/reader/study_reader.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// --until of several answers at once: the worst decides.

namespace asdic::detail::study {
namespace {

Study study_of(const std::string& head, const std::string& summary = "") {
  const support::TemporaryDirectory folder;
  return read_study(folder.write(
      "study.toml",
      "[study]\n" + head +
          "[vary]\n\"target.0.depth\" = { law = \"uniform\", low = 20.0, high = 80.0 }\n"
          "\"environment.wind_speed\" = { law = \"uniform\", low = 3.0, high = 5.0 }\n"
          "[measure]\necho_level = true\ndetection = true\n[summary]\n" +
          summary + support::plain_sea));
}

/// depth, wind, level, detected, …: the deeper the more scatter, detected as a coin falls.
Row row_of(const Study& study, std::uint64_t index) {
  const double depth = 20.0 + 60.0 * uniform_draw(1, index, 0),
               wind = 3.0 + 2.0 * uniform_draw(1, index, 1), u = uniform_draw(1, index, 2);
  Row row{.index = index};
  row.values.assign(columns(study).size(), 0.0);
  row.values[0] = depth;
  row.values[1] = wind;
  row.values[2] = 0.2 * depth * (u - 0.5);
  row.values[3] = uniform_draw(1, index, 3) < 0.5 ? 1.0 : 0.0;
  return row;
}

/// Where a study stops. \param shuffled  rows come in another order
std::uint64_t end_of(const Study& study, const std::vector<std::string>& texts,
                     bool shuffled = false, std::vector<Known>* known = nullptr) {
  OrderedEstimate estimate(RunningEstimate(study), 0, Until(study, texts));
  std::vector<std::uint64_t> order(20000);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (shuffled)  // each within its hundred
    for (std::size_t i = 0; i + 100 <= order.size(); i += 100)
      std::shuffle(order.begin() + std::ptrdiff_t(i), order.begin() + std::ptrdiff_t(i + 100),
                   std::mt19937(7));
  for (const std::uint64_t index : order) {
    estimate.add(row_of(study, index));
    if (estimate.enough()) break;
  }
  if (known != nullptr) *known = estimate.known();
  return estimate.enough().value_or(0);
}

std::string fault_of(const Study& study, const std::vector<std::string>& texts) {
  try {
    static_cast<void>(Until(study, texts));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(Until, TheWorstAnswerDecides) {
  const Study study =
      study_of("realisations = 20000\n",
               "by = [{ axis = \"depth\", bins = 4 }, [\"depth\", \"wind_speed\"]]\n");
  // Half-width of a share of one half: 0.98/√n. 0.05 from n = 385 on, 0.1 of a quarter of the rows.
  EXPECT_EQ(end_of(study, {"0.05"}), 400U);
  EXPECT_EQ(end_of(study, {"pd=0.05"}), 400U);
  std::vector<Known> known;
  const std::uint64_t by_bin = end_of(study, {"pd_by_depth=0.05"}, false, &known);
  EXPECT_TRUE(by_bin == 1600 || by_bin == 2000) << by_bin;  // looks: 1000, 2000
  ASSERT_EQ(known.size(), 1U);
  EXPECT_LE(known[0].half_width, 0.05);
  EXPECT_GT(known[0].half_width, 0.03);
  EXPECT_TRUE(known[0].where.starts_with("depth ")) << known[0].where;
  // The deepest bin scatters most: σ = 0.2·72.5/√12 = 4.2 dB, 1.96σ/√(n/4) ≤ 0.5 from n ≈ 1080.
  EXPECT_EQ(end_of(study, {"echo_level_db_by_depth=0.5"}, false, &known), 2000U);
  EXPECT_EQ(known[0].where, "depth 72.5");
  EXPECT_EQ(end_of(study, {"0.05", "echo_level_db_by_depth=0.5"}), 2000U);
  EXPECT_EQ(end_of(study, {"0.02", "echo_level_db_by_depth=0.5"}), 3000U);
  EXPECT_EQ(end_of(study, {"0.001"}, false, &known), 0U);  // never
  EXPECT_FALSE(known[0].enough());
}

TEST(Until, StopsWhereTheRowsSayWhateverTheirOrder) {
  const Study study = study_of("realisations = 20000\n", "by = [{ axis = \"depth\", bins = 4 }]\n");
  const std::vector<std::string> texts{"pd_by_depth=0.06", "echo_level_db=0.2"};
  EXPECT_EQ(end_of(study, texts), end_of(study, texts, true));
}

TEST(Until, OfIndicesInWholeBlocks) {
  const Study study = study_of("blocks = 5000\ndesign = \"saltelli\"\n", "by = []\n");
  std::vector<Known> known;
  const std::uint64_t end = end_of(study, {"total_order=0.2"}, false, &known);
  EXPECT_GT(end, 0U);
  EXPECT_EQ(end % 4, 0U);
  EXPECT_TRUE(is_look(end / 4));
  EXPECT_TRUE(known[0].where.starts_with("input ")) << known[0].where;
}

TEST(Until, FaultsSayWhatCanBeAskedFor) {
  const Study study = study_of("realisations = 100\n", "by = [\"depth\"]\n");
  EXPECT_EQ(fault_of(study, {"0"}),
            "--until: found \"0\", expected a number above 0, or NAME=NUMBER as in "
            "pd_by_range=0.05");
  EXPECT_NE(fault_of(study, {"pd="}).find("found \"pd=\", expected a number above 0"),
            std::string::npos);
  EXPECT_NE(fault_of(study, {"inf"}).find("expected a number above 0"), std::string::npos);
  const std::string unknown = fault_of(study, {"pd_by_dept=0.1"});
  EXPECT_NE(
      unknown.find("--until: found \"pd_by_dept=0.1\", expected a number, or with the name of "
                   "what is to be known: echo_level_db, pd, pfa, "),
      std::string::npos)
      << unknown;
  EXPECT_NE(unknown.find("pd_by_depth"), std::string::npos);
  EXPECT_NE(unknown.find("(did you mean \"pd_by_depth\"?)"), std::string::npos) << unknown;
  EXPECT_EQ(unknown.find("total_order"), std::string::npos);  // of saltelli alone
  EXPECT_EQ(fault_of(study, {"pd=0.1", "0.2", "pd=0.3"}),
            "--until: found \"pd=0.3\" beside \"pd=0.1\", expected each answer once");
  EXPECT_EQ(Until(study, {"0.05", "pd_by_depth=0.1"}).text(),
            "--until 0.05 --until pd_by_depth=0.1");
}

}  // namespace
}  // namespace asdic::detail::study
