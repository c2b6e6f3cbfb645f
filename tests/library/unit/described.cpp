// What the library tells of settings, and measures of one's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>

#include "asdic/asdic.h"
#include "support/temporary_directory.h"

namespace {

const asdic::Setting& setting(const std::string& path) {
  const auto& all = asdic::settings();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.path == path; });
  EXPECT_NE(at, all.end()) << path;
  return *at;
}

TEST(Settings, TellUnitsRangesWordsAndDefaults) {
  const asdic::Setting& strength = setting("target[].strength_db");
  EXPECT_EQ(strength.kind, asdic::Setting::Kind::number);
  EXPECT_EQ(strength.unit, "dB");
  const asdic::Setting& window = setting("pulse.window");
  EXPECT_EQ(window.kind, asdic::Setting::Kind::word);
  EXPECT_THAT(window.words, testing::Contains("hann"));
  const asdic::Setting& duration = setting("pulse.duration");
  EXPECT_EQ(duration.lowest, 1e-6);
  EXPECT_FALSE(duration.or_zero);
  EXPECT_TRUE(setting("environment.bottom.shear_speed").or_zero);
  const auto& tables = asdic::setting_tables();
  EXPECT_TRUE(std::any_of(tables.begin(), tables.end(),
                          [](const auto& one) { return one.path.starts_with("environment"); }));
}

/// A study of ten rows in still water.
std::filesystem::path study_in(const std::filesystem::path& folder) {
  std::filesystem::copy_file(ASDIC_SCENARIOS "/isovelocity.toml", folder / "isovelocity.toml");
  std::ofstream(folder / "study.toml")
      << "[study]\nscenario = \"isovelocity.toml\"\nrealisations = 10\n"
         "[vary]\n\"target.0.strength_db\" = { law = \"uniform\", low = 0.0, high = 20.0 }\n"
         "[measure]\npaths = true\n";
  return folder / "study.toml";
}

asdic::StudyMeasure strength(std::atomic<int>& calls, const std::string& version = "1") {
  return {.name = "strength",
          .unit = "dB",
          .meaning = "of the target",
          .version = version,
          .samples = false,
          .of = [&](const asdic::Ping& ping) {
            ++calls;
            return ping.scenario().get("target").at(std::size_t{0}).at("strength_db").number();
          }};
}

TEST(StudyMeasure, SeesWhatWasDrawnAndIsNotAskedTwice) {
  const asdic::detail::support::TemporaryDirectory folder;
  const std::filesystem::path file = study_in(folder.path()), output = folder.path() / "out.h5";
  std::atomic<int> calls = 0;
  const asdic::StudyResult made = asdic::study(file, output, {.measures = {strength(calls)}});
  EXPECT_EQ(calls, 10);
  EXPECT_EQ(made.column("strength"), made.column("strength_db"));
  const asdic::StudyResult again = asdic::study(file, output, {.measures = {strength(calls)}});
  EXPECT_EQ(calls, 10);
  EXPECT_EQ(again.column("strength"), made.column("strength"));
  // Another version of it is another study.
  EXPECT_THROW(static_cast<void>(asdic::study(file, output, {.measures = {strength(calls, "2")}})),
               asdic::InputError);
  EXPECT_EQ(asdic::study(file, output, {.measures = {strength(calls, "2")}, .fresh = true}).rows(),
            10U);
}

TEST(StudyMeasure, FaultsAreTold) {
  const asdic::detail::support::TemporaryDirectory folder;
  const std::filesystem::path file = study_in(folder.path()), output = folder.path() / "out.h5";
  std::atomic<int> calls = 0;
  for (const char* name : {"", "Strength", "paths", "strength_db"}) {
    asdic::StudyMeasure measure = strength(calls);
    measure.name = name;
    EXPECT_THROW(static_cast<void>(asdic::study(file, output, {.measures = {measure}})),
                 asdic::InputError)
        << name;
  }
  asdic::StudyMeasure fails = strength(calls);
  fails.of = [](const asdic::Ping&) -> double { throw std::domain_error("mine"); };
  EXPECT_THROW(static_cast<void>(asdic::study(file, output, {.measures = {fails}})),
               std::domain_error);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(
      static_cast<void>(asdic::study(file, output, {.measures = {}, .stop = stop.get_token()})),
      asdic::Stopped);
}

}  // namespace
