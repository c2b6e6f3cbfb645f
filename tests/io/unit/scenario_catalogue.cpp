#include "io/scenario/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/unit_text.h"
#include "io/scenario/document.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "support/plain_sea.h"

namespace asdic::detail::scenario {
namespace {

using testing::Contains;

std::string unit_at(std::string_view key) {
  return asdic::detail::unit_of(setting_at(key).quantity);
}

TEST(ScenarioCatalogue, FindsWhatStandsAtAKey) {
  EXPECT_EQ(unit_at("target.0.strength_db"), "dB");
  EXPECT_EQ(unit_at("transmitter.source_level_db"), "dB re 1 µPa at 1 m");
  EXPECT_EQ(unit_at("noise.spectral_level_db"), "dB re 1 µPa²/Hz");
  EXPECT_EQ(unit_at("environment.sound_speed.speed.3"), "m/s");
  EXPECT_EQ(unit_at("environment.bottom.shape.depth"), "m");
  EXPECT_EQ(setting_at("seed").standard, "1");
  EXPECT_EQ(settings_at("array.phones").size(), 3U);  // of three kinds
  EXPECT_TRUE(settings_at("array.telephones").empty());
  EXPECT_TRUE(settings_at("target.0").empty());  // a table
}

TEST(ScenarioCatalogue, SaysOfEveryKeyWhatItIs) {
  for (const SettingRecord& one : catalogue().settings) {
    EXPECT_FALSE(one.help.empty()) << one.path;
    EXPECT_FALSE(domain_of(one).empty() && one.type != SettingRecord::Type::number) << one.path;
  }
  for (const TableRecord& one : catalogue().tables) EXPECT_FALSE(one.help.empty()) << one.path;
}

/// "target.depth" of "target[0].depth" and "target[].depth"; a radian's key as that of degrees.
std::string plain(std::string key) {
  for (auto open = key.find('['); open != std::string::npos; open = key.find('['))
    key.erase(open, key.find(']', open) - open + 1);
  if (key.ends_with("_rad")) key.replace(key.size() - 4, 4, "_deg");
  return key;
}

// What the reader notes is in the catalogue, key by key.
TEST(ScenarioCatalogue, HasEveryKeyThatIsRead) {
  std::vector<std::string> known;
  for (const SettingRecord& one : catalogue().settings) known.push_back(plain(one.path));
  NotedSettings noted;
  static_cast<void>(
      scenario_of(read_document(support::plain_sea, "sea.toml", {}), "sea.toml", &noted));
  EXPECT_GT(noted.size(), 60U);
  for (const NotedSetting& one : noted) EXPECT_THAT(known, Contains(plain(one.key)));
}

const NotedSetting& find(const NotedSettings& all, const std::string& key) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.key == key; });
  if (found == all.end()) throw std::runtime_error("nothing noted of " + key);
  return *found;
}

TEST(NotedSettings, TellValueUnitAndWhetherItIsGiven) {
  const std::vector<std::string> overrides{
      "target=[{range=3000, bearing_deg=30, depth=120, strength_db=12.5, name=\"ship\"}]",
      "environment.bottom={kind=\"fluid\", shape={range=[0, 1, 2, 3, 4, 5, 6, 7, 8, 9], "
      "depth=[1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 1000, 900]}}",
      "run={memory=\"2 GB\"}"};
  NotedSettings all;
  static_cast<void>(
      scenario_of(read_document(support::plain_sea, "sea.toml", overrides), "sea.toml", &all));
  const auto is = [&](const std::string& key, const std::string& value, const std::string& unit,
                      bool given) {
    EXPECT_EQ(find(all, key), (NotedSetting{key, value, unit, given})) << find(all, key).value;
  };
  is("target[0].name", "\"ship\"", "", true);
  is("target[0].strength_db", "12.5", "dB", true);
  is("target[0].bearing_deg", "30", "degrees", true);
  is("target[0].heading_deg", "its course", "", false);
  is("target[0].last_ping", "no end", "", false);
  is("target[0].velocity", "[0, 0, 0]", "m/s", false);
  is("environment.bottom.shape.range", "10 values, [0, 1, 2, … 9]", "m", true);
  is("environment.bottom.density", "1900", "kg/m3", false);
  is("propagation.band", "\"auto\"", "", false);
  is("propagation.max_bottom_bounces", "0", "", true);
  is("run.memory", "2000000000", "bytes", true);
  std::vector<std::string> keys;
  for (const NotedSetting& one : all) keys.push_back(one.key);
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

TEST(NotedSettings, AreThoseOfARunAsWell) {
  NotedSettings all;
  std::vector<std::string> notes;
  static_cast<void>(propagation_case_of(
      read_document("[environment.sound_speed]\nkind = \"munk\"\n[environment.bottom]\nkind = "
                    "\"rigid\"\ndepth = 5000\n[run]\nfrequency = 50\nsource.depth = 1000\n"
                    "[run.receivers]\ndepth = 800\nrange = { first = 1e3, last = 1e4, count = 10 "
                    "}\n",
                    "run.toml", {}),
      "run.toml", notes, &all));
  EXPECT_EQ(find(all, "run.frequency"), (NotedSetting{"run.frequency", "50", "Hz", true}));
  EXPECT_EQ(
      find(all, "run.receivers.range"),
      (NotedSetting{"run.receivers.range", "10 values, [1000, 2000, 3000, … 10000]", "m", true}));
  EXPECT_EQ(find(all, "run.memory"),
            (NotedSetting{"run.memory", "half of what the process may have", "", false}));
  EXPECT_EQ(find(all, "environment.sound_speed.axis_depth"),
            (NotedSetting{"environment.sound_speed.axis_depth", "1300", "m", false}));
}

}  // namespace
}  // namespace asdic::detail::scenario
