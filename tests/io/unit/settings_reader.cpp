#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "io/scenario/propagation.h"
#include "io/settings/reader.h"
#include "sonar/scenario/scenario.h"
#include "support/ship.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using namespace support;

Ship read(const std::string& text, const std::filesystem::path& folder = {}) {
  const TomlValue root = parse_toml(text, "s.toml");
  KnownSettings known{.numbers = {{"environment.wind_speed", 6.0}}, .folder = folder};
  Ship ship;
  read_settings(TomlTable(root), ship, known);
  return ship;
}

std::string fault(const std::string& text) {
  try {
    static_cast<void>(read(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

constexpr const char* least = "length = 30\n[anchor]\nlinks = 5\n";

TEST(SettingsReader, WhatIsNotThereKeepsItsDefault) {
  const Ship ship = read(least);
  EXPECT_EQ(ship.length, 30.0);
  EXPECT_EQ(ship.heading, radians(90.0));
  EXPECT_EQ(ship.wind, 6.0);  // inherited
  EXPECT_EQ(ship.derived_mass, 7.0);
  EXPECT_FALSE(ship.draught || ship.list || ship.crew || ship.spare);
  EXPECT_EQ(ship.decks, 1);
  EXPECT_EQ(ship.flag, "white");
  EXPECT_EQ(ship.paint, Paint::matt);
  EXPECT_EQ(ship.course, Vec2(1.0, 2.0));
  ASSERT_EQ(ship.masts.size(), 1U);  // one or more
  EXPECT_EQ(ship.masts[0].name, "mast");
  EXPECT_TRUE(std::holds_alternative<Sail>(ship.drive));
  EXPECT_EQ(ship.anchor.links, 5);
}

TEST(SettingsReader, ReadsEveryKindOfSetting) {
  const Ship ship = read(R"(
length = 30.5
heading_deg = -45
wind = 2
draught = 3
list_rad = 0.25
crew = 4
decks = 2
armed = true
flag = "blue"
paint = "gloss"
shine = 0.75
place = [1, 2, 3]
course = [4, 5]
gauges = [6, 7]
bearings_deg = [90, 180]
lamps = [[1, 2, 3], [4, 5, 6]]
kind = "sail"
mast = [{ height = 11 }, { name = "mizzen" }]
range = 8
east = 9
[anchor]
links = 5
[spare]
links = 6
)");
  EXPECT_EQ(ship.length, 30.5);
  EXPECT_EQ(ship.heading, radians(-45.0));
  EXPECT_EQ(ship.wind, 2.0);
  EXPECT_EQ(ship.draught, 3.0);
  EXPECT_EQ(ship.list, 0.25);
  EXPECT_EQ(ship.crew, 4);
  EXPECT_EQ(ship.decks, 2);
  EXPECT_TRUE(ship.armed);
  EXPECT_EQ(ship.flag, "blue");
  EXPECT_EQ(ship.paint, Paint::gloss);
  EXPECT_EQ(ship.shine, 0.75);
  EXPECT_EQ(ship.place, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(ship.course, Vec2(4.0, 5.0));
  EXPECT_EQ(ship.gauges, (std::vector<double>{6.0, 7.0}));
  EXPECT_EQ(ship.bearings, (std::vector<double>{radians(90.0), radians(180.0)}));
  ASSERT_EQ(ship.lamps.size(), 2U);
  EXPECT_EQ(ship.lamps[1], Vec3(4.0, 5.0, 6.0));
  ASSERT_EQ(ship.masts.size(), 2U);
  EXPECT_EQ(ship.masts[0].name, "mast 1");
  EXPECT_EQ(ship.masts[0].height, 11.0);
  EXPECT_EQ(ship.masts[1].name, "mizzen");
  EXPECT_EQ(ship.masts[1].height, 10.0);
  ASSERT_TRUE(ship.spare);
  EXPECT_EQ(ship.spare->links, 6);
  EXPECT_EQ(ship.range, 8.0);
  EXPECT_EQ(ship.east, 9.0);
}

TEST(SettingsReader, ReadsAxesFilesRowsAndWordsInPlaceOfNumbers) {
  const support::TemporaryDirectory folder;
  std::ofstream(folder.path() / "harbour.txt") << "here\n";
  Ship ship = read(
      "bounces = \"auto\"\ntrim = \"level\"\nportholes = { first = 1, last = 2, count = 3 "
      "}\nchart = \"harbour.txt\"\nseats = [[1, 2], [3, 4]]\nballast = { depth = [1, 1], "
      "mass = [5, 6] }\nleaks = true\nmotto = \"row\"\n" +
          std::string(least),
      folder.path());
  EXPECT_FALSE(ship.bounces || ship.trim);
  EXPECT_EQ(ship.portholes, (std::vector<double>{1.0, 1.5, 2.0}));
  EXPECT_EQ(ship.chart, (folder.path() / "harbour.txt").string());
  EXPECT_EQ(ship.seats, (std::vector<std::vector<double>>{{1.0, 2.0}, {3.0, 4.0}}));
  EXPECT_EQ(ship.ballast, 5.0);
  ASSERT_TRUE(ship.tanks);
  EXPECT_EQ(ship.tanks->mass, (std::vector<double>{5.0, 6.0}));
  EXPECT_TRUE(ship.leaks);
  ship = read("bounces = 3\ntrim = -2\nportholes = 4\nballast = 8\n" + std::string(least));
  EXPECT_EQ(ship.bounces, 3);
  EXPECT_EQ(ship.trim, -2.0);
  EXPECT_EQ(ship.portholes, (std::vector<double>{4.0}));
  EXPECT_EQ(ship.ballast, 8.0);
  EXPECT_FALSE(ship.tanks);
  ship = read("portholes = [4, 6]\n" + std::string(least));
  EXPECT_EQ(ship.portholes, (std::vector<double>{4.0, 6.0}));
  EXPECT_EQ(ship.bounces, 7);
  EXPECT_EQ(ship.trim, 0.0);
}

TEST(SettingsReader, AnotherAlternativeBeginsWithItsDefaults) {
  const Ship ship =
      read("kind = \"engine\"\ndepth = [3, 4]\npitch_deg = [10, 20]\n" + std::string(least));
  const auto& engine = std::get<Engine>(ship.drive);
  EXPECT_EQ(engine.speed, (std::vector<double>{3.0, 4.0}));
  EXPECT_EQ(engine.angle, (std::vector<double>{radians(10.0), radians(20.0)}));
}

TEST(SettingsReader, ColumnsMayStandInAFile) {
  const support::TemporaryDirectory folder;
  std::ofstream(folder.path() / "screw.csv") << "depth,pitch_deg\n1,5\n2,6\n";
  const Ship ship =
      read("kind = \"engine\"\nfile = \"screw.csv\"\n" + std::string(least), folder.path());
  EXPECT_EQ(std::get<Engine>(ship.drive).angle, (std::vector<double>{radians(5.0), radians(6.0)}));
}

// Each kind of setting, with what is wrong with it, at its line.
TEST(SettingsReader, EveryFaultNamesItsPlace) {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"", "s.toml:1: length: found nothing, expected a length above 0 m"},
      {"length = -2\n", "s.toml:1: length: found -2 m, expected a length above 0 m"},
      {"lenght = 30\n",
       "s.toml:1: lenght: found an unknown key, expected a known key (did you mean \"length\"?)"},
      {"length = 501\n[anchor]\nlinks = 5\n",
       "s.toml:1: length: found 501, expected a ship that fits the harbour"},
      {"length = 30\nheading_deg = 400\n",
       "s.toml:2: heading_deg: found 400 degrees, expected a heading from -360 to 360 degrees"},
      {"length = 30\nheading_deg = 40\nheading_rad = 1\n",
       "s.toml:3: heading_rad: found 1, expected no \"heading_rad\" beside heading_deg"},
      {"length = 30\nheading = 40\n[anchor]\nlinks = 5\n",
       "s.toml:2: heading: found an unknown key, expected a known key (did you mean "
       "\"heading_deg\"?)"},
      {"length = 30\ncrew = 10\n", "s.toml:2: crew: found 10, expected a whole number from 1 to 9"},
      {"length = 30\ndecks = 1.5\n",
       "s.toml:2: decks: found 1.5, expected a whole number from 1 to 9"},
      {"length = 30\narmed = 1\n", "s.toml:2: armed: found 1, expected true or false"},
      {"length = 30\nflag = 1\n", "s.toml:2: flag: found 1, expected a string"},
      {"length = 30\npaint = \"glos\"\n",
       "s.toml:2: paint: found \"glos\", expected \"none\", \"matt\" or \"gloss\" (did you mean "
       "\"gloss\"?)"},
      {"length = 30\npaint = \"gloss\"\n",
       "s.toml:1: shine: found nothing, expected a share from 0 to 1"},
      {"length = 30\nplace = [1, 2]\n",
       "s.toml:2: place: found an array of 2, expected [fore, starboard, down] in m"},
      {"length = 30\ncourse = [1, 200]\n",
       "s.toml:2: course[1]: found 200 m/s, expected a velocity from -100 to 100 m/s"},
      {"length = 30\ngauges = [1,\n-2]\n",
       "s.toml:3: gauges[1]: found -2 m, expected a depth from 0 to 12000 m"},
      {"length = 30\nbearings_deg = [1, 900]\n",
       "s.toml:2: bearings_deg[1]: found 900 degrees, expected a bearing from -360 to 360 degrees"},
      {"length = 30\nlamps = 5\n",
       "s.toml:2: lamps: found 5, expected an array of [east, north, depth] in m"},
      {"length = 30\nbounces = \"aut\"\n",
       "s.toml:2: bounces: found \"aut\", expected \"auto\" (did you mean \"auto\"?)"},
      {"length = 30\nbounces = 12\n",
       "s.toml:2: bounces: found 12, expected a whole number from 0 to 9"},
      {"length = 30\nportholes = { first = 0, last = 1 }\n",
       "s.toml:2: portholes.count: found nothing, expected a whole number from 1 to 10000000"},
      {"length = 30\nchart = \"atlantis\"\n",
       "s.toml:2: chart: found no such file \"atlantis\", expected a chart that is there"},
      {"length = 30\nballast = -1\n",
       "s.toml:2: ballast: found -1 t, expected a mass of at least 0 t"},
      {"length = 30\nballast = { depth = [1, 1, 0.5], mass = [5, 6, 7] }\n",
       "s.toml:2: ballast.depth[2]: found 0.5 m, expected a depth not above the one before it, 1 "
       "m"},
      {"length = 30\n[[mast]]\n[[mast]]\nname = \"mast 1\"\n",
       "s.toml:4: mast[1].name: found \"mast 1\", expected a name that no other mast has"},
      {"length = 30\nmast = { height = -1 }\n",
       "s.toml:2: mast.height: found -1 m, expected a height of at least 0 m"},
      {"length = 30\nkind = \"oar\"\n",
       "s.toml:2: kind: found \"oar\", expected \"sail\" or \"engine\""},
      {"length = 30\nkind = \"engine\"\ndepth = [2, 2]\npitch_deg = [0, 0]\n",
       "s.toml:3: depth[1]: found 2 m, expected a depth below the one before it, 2 m"},
      {"length = 30\nkind = \"engine\"\ndepth = [2, 3]\npitch_deg = [0]\n",
       "s.toml:4: pitch_deg: found an array of 1, expected as many values as depths, 2"},
      {"length = 30\n[anchor]\nlinks = 0\n",
       "s.toml:3: anchor.links: found 0, expected a whole number from 1 to 100"},
      {"length = 30\n[anchor]\nlinks = 5\nlink = 3\n",
       "s.toml:4: anchor.link: found an unknown key, expected a known key (did you mean "
       "\"links\"?)"},
      {"length = 30\nnorth = 1\nrange = 2\n[anchor]\nlinks = 5\n",
       "s.toml:2: north: found 1, expected no \"north\" beside range"},
      {"length = 30\nsailcloth = 10\nkind = \"engine\"\ndepth = [1]\npitch_deg = "
       "[1]\n[anchor]\nlinks = "
       "5\n",
       "s.toml:2: sailcloth: found an unknown key, expected one of "},
  };
  for (const auto& [text, expected] : faults)
    EXPECT_THAT(fault(text), testing::StartsWith(expected)) << text;
}

TEST(SettingsReader, AReferenceNamesAnElementOfTheListBefore) {
  const TomlValue root = parse_toml("on = \"mizzen\"\n", "s.toml");
  KnownSettings known{.names = {{"mast", {"main", "mizzen"}}}};
  Sail sail;
  read_settings(TomlTable(root), sail, known);
  EXPECT_EQ(sail.mast, 1);
  known.names["mast"] = {"main"};
  EXPECT_THROW(read_settings(TomlTable(root), sail, known), InputError);
}

// Not every angle has a decimal number of degrees: radians are taken, and are no key to offer.
TEST(SettingsReader, RadiansAreTakenQuietly) {
  EXPECT_EQ(read("heading_rad = 0.1\n" + std::string(least)).heading, 0.1);
  const Ship ship =
      read("kind = \"engine\"\ndepth = [3, 4]\npitch_rad = [0.1, 0.2]\n" + std::string(least));
  EXPECT_EQ(std::get<Engine>(ship.drive).angle, (std::vector<double>{0.1, 0.2}));
  EXPECT_THAT(fault("zzzzzzzzz = 1\n" + std::string(least)),
              testing::AllOf(testing::HasSubstr("\"heading_deg\""),
                             testing::Not(testing::HasSubstr("_rad"))));
}

/// A stop of a voyage: each later than the one before it.
struct Stop {
  double day = 0.0;
  void describe(Fields& field, const Stop* before) {
    field(required("day"), day, Quantity{.noun = "day"}, "of arrival");
    if (field.checks() && before != nullptr && day <= before->day)
      field.fault("day", "a day after " + std::to_string(int(before->day)));
  }
};
struct Voyage {
  std::vector<Stop> stops;
  double trim = 0.1, speed = 5.0;
  void describe(Fields& field) {
    field("stop", stops, "one after the other");
    field("trim", trim,
          AngleQuantity{.noun = "trim", .low_deg = 0.0, .high_deg = 10.0, .above = true}, "aft");
    if (field.checks() && trim > 0.15) field.fault("trim", "a trim that cargo bears");
    if (field.finds("speed")) field.excludes("speed", {"knots", "revolutions"});
    field("speed", speed, Quantity{.noun = "speed"}, "through the water");
    field.note("it sails");
  }
};
std::string fault_of_voyage(const std::string& text) {
  const TomlValue root = parse_toml(text, "s.toml");
  KnownSettings known;
  Voyage voyage;
  try {
    read_settings(TomlTable(root), voyage, known);
  } catch (const InputError& error) {
    return error.what();
  }
  EXPECT_EQ(known.notes, std::vector<std::string>{"it sails"});
  return "none after " + std::to_string(voyage.stops.size());
}
TEST(SettingsReader, AnElementIsHeldAgainstTheOneBeforeIt) {
  EXPECT_EQ(fault_of_voyage("[[stop]]\nday = 1\n[[stop]]\nday = 2\n"), "none after 2");
  EXPECT_EQ(fault_of_voyage("[[stop]]\nday = 2\n[[stop]]\nday = 3\n[[stop]]\n\nday = 3\n"),
            "s.toml:7: stop[2].day: found 3, expected a day after 3");
}
TEST(SettingsReader, FaultsOfAnglesNameTheKeyThatIsThere) {
  EXPECT_EQ(fault_of_voyage("trim_deg = 0\n"),
            "s.toml:1: trim_deg: found 0 degrees, expected a trim above 0 and at most 10 degrees");
  EXPECT_EQ(fault_of_voyage("trim_deg = 9\n"),
            "s.toml:1: trim_deg: found 9, expected a trim that cargo bears");
  EXPECT_EQ(fault_of_voyage("\ntrim_rad = 0.16\n"),
            "s.toml:2: trim_rad: found 0.16, expected a trim that cargo bears");
}
TEST(SettingsReader, KeysThatExcludeOneAnother) {
  EXPECT_EQ(fault_of_voyage("speed = 1\nrevolutions = 2\n"),
            "s.toml:2: revolutions: found 2, expected no \"revolutions\" beside speed");
}

// The last value of an enumeration has the last of its words: none was left out.
template <Worded E>
void expect_words(E last, std::string_view word) {
  EXPECT_EQ(word_of(last), word);
  EXPECT_EQ(std::span<const std::string_view>(words(last)).back(), word);
}
TEST(SettingsReader, EnumerationsHaveAWordForEachValue) {
  expect_words(Taper::omnidirectional, "omnidirectional");
  expect_words(BearingFrame::heading, "heading");
  expect_words(PulseWindow::tukey, "tukey");
  expect_words(NoiseCoherence::profile, "profile");
  expect_words(Fluctuation::swerling_4, "swerling-4");
  expect_words(Samples::baseband, "baseband");
  expect_words(ScattererSynthesis::streams, "streams");
  expect_words(ScattererMotion::Kind::spread, "spread");
  expect_words(Task::field, "field");
  expect_words(FieldKind::semi_coherent, "semi-coherent");
  expect_words(FieldSolver::waves, "waves");
  expect_words(BeamKind::cerveny_ray_centred, "cerveny-ray-centred");
  expect_words(SourceKind::line, "line");
  expect_words(CervenyBeams::Width::cerveny, "cerveny");
  expect_words(CervenyBeams::Curvature::zero, "zero");
  expect_words(CervenyBeams::Component::horizontal, "horizontal");
}

TEST(SettingsReader, ReadsAWordOfATableThatIsReadByHand) {
  const TomlValue root = parse_toml("window = \"hann\"\nkind = \"lfn\"\n", "s.toml");
  TomlTable table(root);
  EXPECT_EQ(read_word(table, "window", PulseWindow::none), PulseWindow::hann);
  EXPECT_EQ(read_word(table, "edges", PulseWindow::tukey), PulseWindow::tukey);
  EXPECT_THROW(static_cast<void>(read_word(table, required("kind"), PulseWindow::none)),
               InputError);
}

}  // namespace
}  // namespace asdic::detail
