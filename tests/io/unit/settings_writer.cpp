#include "io/settings/writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "core/settings_words.h"
#include "io/settings/axis.h"
#include "io/settings/reader.h"
#include "support/ship.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using namespace support;

// Numbers without a short decimal, angles without any in degrees.
Ship any_ship() {
  Ship ship;
  ship.length = 100.0 / 3.0;
  ship.wind = 1.0 / 7.0;
  ship.masts = {Mast{.name = "fore", .height = 0.1 + 0.2}, Mast{.name = "main", .height = 1e-300}};
  ship.place = {-0.0, 1.0 / 3.0, 2.0};
  ship.range = 1.0;
  ship.east = 5.0;
  return ship;
}

Ship read_back(const std::string& text, const std::filesystem::path& folder = {}) {
  const TomlValue root = parse_toml(text, "s.toml");
  KnownSettings known{.numbers = {{"environment.wind_speed", 6.0}}, .folder = folder};
  Ship ship;
  read_settings(TomlTable(root), ship, known);
  return ship;
}

// What is written reads back as the same numbers and choices, bit for bit, and as the same text.
TEST(SettingsWriter, EverySettingReadsBackBitForBit) {
  const std::vector<void (*)(Ship&)> changes = {
      [](Ship&) {},
      [](Ship& ship) { ship.heading = 0.1; },
      [](Ship& ship) { ship.heading = radians(-12.5); },
      [](Ship& ship) { ship.draught = 1e-7; },
      [](Ship& ship) { ship.list = 0.2; },
      [](Ship& ship) { ship.crew = 4; },
      [](Ship& ship) { ship.decks = 9; },
      [](Ship& ship) { ship.armed = true; },
      [](Ship& ship) { ship.paint = Paint::none; },
      [](Ship& ship) { ship.paint = Paint::gloss, ship.shine = 1.0 / 3.0; },
      [](Ship& ship) {
        ship.course = {-7.0, 0.3};
      },
      [](Ship& ship) { ship.gauges.assign(30, 0.7); },
      [](Ship& ship) {
        ship.bearings = {radians(90.0), 0.3};
      },
      [](Ship& ship) {
        ship.bearings = {radians(90.0), radians(30.5)};
      },
      [](Ship& ship) {
        ship.lamps = {{1.0, 2.0, 0.3}, {4.0, 5.0, 6.0}};
      },
      [](Ship& ship) { std::get<Sail>(ship.drive) = {.mast = 1, .area = 0.7}; },
      [](Ship& ship) { ship.drive = Engine{}; },
      [](Ship& ship) {
        ship.drive = Engine{{1.0, 2.0, 3.0}, {0.0, radians(5.0), 0.1}};
      },
      [](Ship& ship) { ship.anchor.links = 99; },
      [](Ship& ship) { ship.spare = Anchor{}; },
      [](Ship& ship) { ship.range = 0.0, ship.east = 8.0; },
      [](Ship& ship) { ship.bounces = std::nullopt; },
      [](Ship& ship) { ship.bounces = 0; },
      [](Ship& ship) { ship.trim = -0.0; },
      [](Ship& ship) { ship.trim = 0.3; },
      [](Ship& ship) {
        ship.portholes = {1.0, 1.0 / 3.0};
      },
      [](Ship& ship) { ship.portholes = evenly_spaced(0.1, 7.0 / 3.0, 101); },
      [](Ship& ship) {
        ship.seats = {{1.0, 2.0}, {3.0, 0.4}};
      },
      [](Ship& ship) { ship.ballast = 0.0; },
      [](Ship& ship) {
        ship.tanks = Tanks{{1.0, 1.0, 2.0}, {0.1, 0.2, 0.3}};
      },
      [](Ship& ship) { ship.leaks = true; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Ship ship = any_ship();
    changes[i](ship);
    const std::string text = print_toml(settings_tree(ship));
    const Ship same = read_back(text);
    EXPECT_EQ(settings_words(same), settings_words(ship)) << i << "\n" << text;
    EXPECT_EQ(print_toml(settings_tree(same)), text) << i;
  }
}

TEST(SettingsWriter, TextsAndFilesReadBack) {
  const support::TemporaryDirectory folder;
  std::ofstream(folder.path() / "harbour.txt") << "here\n";
  Ship ship = any_ship();
  ship.flag = "quoted \"twice\" \\ and\ttabbed";
  ship.motto = "row";
  ship.chart = (folder.path() / "harbour.txt").string();
  ship.masts[1].name.clear();  // it gets the name that the reader would give it
  const Ship same = read_back(print_toml(settings_tree(ship)));
  EXPECT_EQ(same.flag, ship.flag);
  EXPECT_EQ(same.motto, "row");
  EXPECT_EQ(same.chart, ship.chart);
  EXPECT_EQ(same.masts[0].name, "fore");
  EXPECT_EQ(same.masts[1].name, "mast 2");
}

TEST(SettingsWriter, ElementsOfOneNameAreToldApart) {
  Ship ship = any_ship();
  ship.masts = {Mast{.name = "mast"}, Mast{.name = "mast"}, Mast{.name = "mast 2"}, Mast{}};
  std::get<Sail>(ship.drive).mast = 1;
  const Ship same = read_back(print_toml(settings_tree(ship)));
  ASSERT_EQ(same.masts.size(), 4U);
  EXPECT_EQ(same.masts[0].name, "mast");
  EXPECT_EQ(same.masts[1].name, "mast 2");
  EXPECT_EQ(same.masts[2].name, "mast 2 2");
  EXPECT_EQ(same.masts[3].name, "mast 4");
  EXPECT_EQ(std::get<Sail>(same.drive).mast, 1);
}

TEST(SettingsWriter, WritesValuesFirstAndThenTheTablesBelow) {
  Ship ship = any_ship();
  ship.length = 30.0;
  ship.wind = 6.0;
  ship.masts = {Mast{.name = "fore", .height = 11.0}, Mast{.name = "main", .height = 12.0}};
  ship.place = {1.0, 2.0, 3.0};
  ship.gauges = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
  ship.lamps = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  ship.portholes = {0.0, 1.0, 2.0, 3.0};
  ship.bounces = std::nullopt;
  ship.spare = Anchor{};
  ship.tanks = Tanks{{1.0}, {2.0}};
  EXPECT_EQ(print_toml(settings_tree(ship)), R"(length = 30
heading_deg = 90
wind = 6
decks = 1
armed = false
flag = "white"
paint = "matt"
place = [1, 2, 3]
course = [1, 2]
gauges = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12,
  13]
lamps = [[1, 2, 3],
  [4, 5, 6]]
bounces = "auto"
portholes = { first = 0, last = 3, count = 4 }
# for the owner
kind = "sail"
on = "fore"
sailcloth = 50
range = 1
east = 5

[[mast]]
name = "fore"
height = 11

[[mast]]
name = "main"
height = 12

[ballast]
depth = [1]
mass = [2]

[anchor]
links = 3

[spare]
links = 3
)");
}

TEST(SettingsWriter, AReferenceNamesAnElementThatTheCallerKnows) {
  const TomlValue tree =
      settings_tree(Sail{.mast = 1}, {.numbers = {}, .names = {{"mast", {"main", "mizzen"}}}});
  EXPECT_EQ(print_toml(tree), "on = \"mizzen\"\nsailcloth = 50\n");
}

// What the file of a study or of a server's settings may hold: any key, any nesting.
TEST(SettingsWriter, PrintsAnyTree) {
  const std::string text = R"(a = [[1, 2],
  [3]]
"b c" = [{"x" = 1}, 2]
e = []

[d]

[d."f.g"]
h = true
)";
  EXPECT_EQ(print_toml(parse_toml(text, "s.toml")), text);
}

}  // namespace
}  // namespace asdic::detail
