// The public face: a scenario as a document of settings, and the faults in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "asdic/asdic.h"
#include "support/program.h"

namespace {

namespace support = asdic::detail::support;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

asdic::Scenario built() {
  asdic::Scenario scenario;
  scenario.set("title", "built")
      .set("environment.sound_speed", asdic::SoundSpeed{.depth = {0.0}, .speed = {1500.0}})
      .set("environment.bottom", asdic::Bottom{.depth = 1000.0, .kind = "rigid"})
      .set("environment.absorption.kind", "none")
      .set("platform", asdic::Platform{.position = {0.0, 0.0, 200.0}})
      .set("transmitter", asdic::Transmitter{.source_level_db = 200.0, .taper = "omnidirectional"})
      .set("pulse", asdic::Cw{.frequency = 1000.0, .duration = 0.1})
      .set("array", asdic::LineArray{.phones = 2, .spacing = 0.75})
      .add("target",
           asdic::Target{
               .name = "rock", .position = asdic::Vector{3000.0, 0.0, 500.0}, .strength_db = 10.0})
      .set("reverberation.enabled", false)
      .set("pings.recording_duration", 5.0)
      .set("pings.sample_rate", 8000.0);
  return scenario;
}

/// What an InputError says of some work.
template <class Work>
asdic::InputError fault_of(const Work& work) {
  try {
    work();
  } catch (const asdic::InputError& error) {
    return error;
  }
  throw std::runtime_error("no fault");
}

TEST(PublicScenario, SetsAndGetsWhatWasSet) {
  asdic::Scenario scenario = built();
  EXPECT_EQ(scenario.get("pulse.frequency").number(), 1000.0);
  EXPECT_EQ(scenario.get("array.phones").whole(), 2);
  EXPECT_EQ(scenario.get("target.0.name").text(), "rock");
  EXPECT_THAT(scenario.get("platform.position").numbers(), ElementsAre(0.0, 0.0, 200.0));
  EXPECT_FALSE(scenario.get("reverberation.enabled").flag());
  EXPECT_FALSE(scenario.has("target.1"));
  scenario.add("target", asdic::Target{.range = 2000.0, .depth = 100.0, .strength_db = 5.0});
  EXPECT_EQ(scenario.get("target").size(), 2U);
  scenario.set("target.1.range", 2500).erase("target.0");
  EXPECT_EQ(scenario.get("target.0.range").number(), 2500.0);
  scenario.erase("target.0.depth").erase("nothing.there");
  EXPECT_THAT(scenario.get("target.0").keys(), ElementsAre("range", "strength_db"));
}

TEST(PublicScenario, ACopyIsItsOwn) {
  const asdic::Scenario one = built();
  asdic::Scenario other = one;
  other.set("pulse.duration", 0.2);
  EXPECT_EQ(one.get("pulse.duration").number(), 0.1);
  EXPECT_EQ(other.get("pulse.duration").number(), 0.2);
}

// Every kind of value, a key in quotes, tables in lists in tables.
TEST(PublicScenario, ItsTextMakesItAgain) {
  asdic::Scenario scenario = built();
  asdic::Target submarine{.name = "a \"name\"", .range = 4000.0, .depth = 1e2 / 3.0};
  submarine.highlights = {{.offset = {30.0, 0.0, -3.0}, .strength_db = 7.0},
                          {.aspect = asdic::Aspect{.bow_db = 1.0, .beam_db = 9.0}}};
  submarine.heading_deg = 33.0;
  scenario.add("target", submarine)
      .add("reverberation.volume", asdic::VolumeLayer{300.0, 400.0, -75.0});
  scenario.set("a.\"dotted.name\"", asdic::Value::list({true, "text", 5}));
  const asdic::Scenario again = asdic::Scenario::parse(scenario.to_toml());
  const auto sorted = [](asdic::Scenario read) { return read.set("title", "built").to_toml(); };
  EXPECT_EQ(sorted(asdic::Scenario::parse(sorted(again))), sorted(again)) << scenario.to_toml();
  EXPECT_EQ(again.get("target.1.depth").number(), 1e2 / 3.0);
  EXPECT_EQ(again.get("target.1.highlight.1.aspect.beam_db").number(), 9.0);
  EXPECT_TRUE(again.get("a.\"dotted.name\"").at(0).flag());
}

TEST(PublicScenario, OneThatIsReadKeepsItsTextUntilItIsChanged) {
  const asdic::Scenario read = asdic::Scenario::parse(support::small_scenario);
  EXPECT_EQ(read.to_toml(), support::small_scenario);
  asdic::Scenario changed = read;
  changed.set("seed", 4);
  EXPECT_THAT(changed.to_toml(), HasSubstr("seed = 4\n"));
  EXPECT_EQ(asdic::Scenario::parse(changed.to_toml()).validate(), changed.validate());
}

// A scenario file and an ocean that it includes: what is set later stands.
TEST(PublicScenario, WhatAnIncludeBringsIsInTheText) {
  const support::TemporaryDirectory folder;
  static_cast<void>(folder.write("ocean.toml", "[environment]\nwind_speed = 3.0\n"));
  const auto path = folder.write("s.toml", "include = \"ocean.toml\"\n[pulse]\nduration = 1.0\n");
  asdic::Scenario scenario = asdic::Scenario::read(path);
  EXPECT_EQ(scenario.get("environment.wind_speed").number(), 3.0);
  scenario.set("pulse.duration", 2.0);
  EXPECT_FALSE(scenario.has("include"));
  EXPECT_THAT(scenario.to_toml(), HasSubstr("wind_speed = 3\n"));
  EXPECT_EQ(asdic::Scenario::read(path, std::vector<std::string>{"pulse.duration=7"})
                .get("pulse.duration")
                .number(),
            7.0);
}

TEST(PublicScenario, AFaultOfAFileHasFileLineKeyFoundAndExpected) {
  std::string text = support::small_scenario;
  text.replace(text.find("duration = 0.1"), 14, "duraton = 0.1");
  const asdic::InputError error =
      fault_of([&] { asdic::Scenario::parse(text, "sea/small.toml").validate(); });
  EXPECT_EQ(error.file(), "sea/small.toml");
  EXPECT_EQ(error.line(), 21);
  EXPECT_EQ(error.key(), "pulse.duraton");
  EXPECT_EQ(error.found(), "an unknown key");
  EXPECT_THAT(error.expected(), HasSubstr("did you mean \"duration\"?"));
  EXPECT_STREQ(error.what(), ("sea/small.toml:21: pulse.duraton: found an unknown key, expected " +
                              error.expected())
                                 .c_str());
}

TEST(PublicScenario, AFaultOfWhatWasSetHasItsKey) {
  asdic::Scenario scenario = built();
  scenario.set("pulse.duration", -1.0);
  const asdic::InputError error = fault_of([&] { scenario.validate(); });
  EXPECT_EQ(error.file(), "");
  EXPECT_EQ(error.line(), 0);
  EXPECT_EQ(error.key(), "pulse.duration");
  EXPECT_EQ(error.found(), "-1 s");
  EXPECT_EQ(fault_of([] { asdic::Scenario().validate(); }).key(), "pulse.kind");
}

TEST(PublicScenario, AFaultOfAChangeHasItsKey) {
  const support::TemporaryDirectory folder;
  const auto path = folder.write("sea.toml", support::small_scenario);
  const asdic::InputError error = fault_of([&] {
    asdic::Scenario::read(path, std::vector<std::string>{"pulse.duration=-1"}).validate();
  });
  EXPECT_EQ(error.file(), "");
  EXPECT_EQ(error.key(), "pulse.duration");
}

TEST(PublicScenario, NothingIsNoValue) {
  asdic::Scenario scenario = built();
  EXPECT_THROW(scenario.set("title", asdic::Value()), asdic::InputError);
  EXPECT_THROW(scenario.add("target", asdic::Value()), asdic::InputError);
  EXPECT_THROW(static_cast<void>(asdic::Value::list({1.0, asdic::Value()})), asdic::InputError);
  EXPECT_EQ(scenario.to_toml(), built().to_toml());
}

TEST(PublicScenario, AFaultOfTomlHasItsLine) {
  const asdic::InputError error =
      fault_of([] { static_cast<void>(asdic::Scenario::parse("a = 1\nb = = 2\n", "x.toml")); });
  EXPECT_EQ(error.file(), "x.toml");
  EXPECT_EQ(error.line(), 2);
}

TEST(PublicScenario, PathsThroughNothingAreRefused) {
  asdic::Scenario scenario = built();
  EXPECT_THROW(scenario.set("target.1.range", 1.0), asdic::InputError);
  EXPECT_THROW(scenario.set("pulse.duration.seconds", 1.0), asdic::InputError);
  EXPECT_THROW(static_cast<void>(scenario.get("pulse.nothing")), asdic::InputError);
  EXPECT_THROW(scenario.add("title", asdic::Value::table()), asdic::InputError);
  EXPECT_THROW(static_cast<void>(asdic::Scenario::read("no such file")), asdic::InputError);
}

TEST(PublicValue, SaysWhatItIs) {
  EXPECT_EQ(asdic::Value().kind(), asdic::Value::Kind::nothing);
  EXPECT_EQ(asdic::Value(true).kind(), asdic::Value::Kind::flag);
  EXPECT_EQ(asdic::Value(3U).kind(), asdic::Value::Kind::whole);
  EXPECT_EQ(asdic::Value(3.0).kind(), asdic::Value::Kind::number);
  EXPECT_EQ(asdic::Value("a").kind(), asdic::Value::Kind::text);
  EXPECT_EQ(asdic::Value(std::vector<double>{1.0}).kind(), asdic::Value::Kind::list);
  EXPECT_EQ(asdic::Value::table().kind(), asdic::Value::Kind::table);
  EXPECT_EQ(asdic::Value(3).number(), 3.0);
  EXPECT_EQ(fault_of([] { static_cast<void>(asdic::Value("a").number()); }).expected(), "a number");
  EXPECT_EQ(fault_of([] { static_cast<void>(asdic::Value::table().at("x")); }).found(), "\"x\"");
}

// Every struct of settings, in a scenario that is then read and checked.
TEST(PublicSettings, StructsWriteTheKeysThatFilesHave) {
  const std::vector<asdic::Value> pulses = {
      asdic::Cw{.frequency = 1000.0, .duration = 0.1, .window = "hann"},
      asdic::Lfm{.start_frequency = 900.0, .end_frequency = 1100.0, .duration = 0.1},
      asdic::Hfm{.start_frequency = 1100.0,
                 .end_frequency = 900.0,
                 .duration = 0.1,
                 .window = "tukey",
                 .tukey_fraction = 0.2},
      asdic::Sfm{.frequency = 1000.0,
                 .swing = 100.0,
                 .modulation_frequency = 20.0,
                 .end_modulation_frequency = 30.0,
                 .duration = 0.1},
      asdic::Costas{.frequency = 1000.0, .order = {1, 2, 4, 3}, .duration = 0.1},
      asdic::Costas{.frequency = 1000.0, .prime = 7, .root = 5, .step = 50.0, .duration = 0.1},
      asdic::Ptfm{.start_frequency = 950.0, .end_frequency = 1050.0, .sweeps = 4, .duration = 0.1},
      asdic::GeometricComb{
          .start_frequency = 900.0, .end_frequency = 1100.0, .lines = 4, .duration = 0.1},
      asdic::PulseTrain{.frequency = 1000.0, .pulses = 3, .pulse_duration = 0.02, .duration = 0.1},
      asdic::PulseTrain{.start_frequency = 900.0,
                        .end_frequency = 1100.0,
                        .pulses = 3,
                        .pulse_duration = 0.02,
                        .duration = 0.1}};
  for (const asdic::Value& pulse : pulses) EXPECT_NO_THROW(built().set("pulse", pulse).validate());
  const std::vector<asdic::Value> waters = {
      asdic::SoundSpeed{
          .depth = {0.0, 1000.0}, .speed = {1490.0, 1510.0}, .interpolation = "pchip"},
      asdic::Munk{},
      asdic::TemperatureSalinity{
          .depth = {0.0, 1000.0}, .temperature = {12.0, 6.0}, .salinity = {35.0, 35.0}},
      asdic::SoundSpeedSection{.range = {0.0, 5e3},
                               .depth = {0.0, 1000.0},
                               .speed = {{1500.0, 1510.0}, {1495.0, 1505.0}}}};
  for (const asdic::Value& water : waters)
    EXPECT_NO_THROW(built().set("environment.sound_speed", water).validate());
  const std::vector<asdic::Value> bottoms = {
      asdic::Bottom{
          .depth = 900.0, .speed = 1700.0, .density = 1900.0, .attenuation_db_per_wavelength = 0.5},
      asdic::Bottom{.depth = 900.0,
                    .kind = "elastic",
                    .speed = 3000.0,
                    .density = 2200.0,
                    .attenuation_db_per_wavelength = 0.1,
                    .shear_speed = 1000.0,
                    .shear_attenuation_db_per_wavelength = 0.2},
      asdic::Bottom{.depth = 900.0, .kind = "grain-size", .grain_size = 3.0},
      asdic::Bottom{.bathymetry = asdic::Bathymetry{{0.0, 9e3}, {900.0, 950.0}, "smooth"}}};
  for (const asdic::Value& bottom : bottoms)
    EXPECT_NO_THROW(built().set("environment.bottom", bottom).validate());
  const std::vector<asdic::Value> arrays = {
      asdic::LineArray{.name = "line", .offset = {0.0, 0.0, 2.0}, .phones = 3, .pitch_deg = 90.0},
      asdic::PhonePositions{.positions = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}},
      asdic::TowedArray{.behind = {100.0, 101.0}, .heading_deg = 10.0}};
  for (const asdic::Value& array : arrays) EXPECT_NO_THROW(built().set("array", array).validate());
  for (const asdic::Value& law : std::initializer_list<asdic::Value>{
           asdic::NrlSurface{}, asdic::ChapmanHarris{}, asdic::OgdenErskine{},
           asdic::ScatteringTable{{1.0, 80.0}, {-50.0, -20.0}}})
    EXPECT_NO_THROW(
        built().set("reverberation.enabled", true).set("reverberation.surface", law).validate());
  for (const asdic::Value& law :
       std::initializer_list<asdic::Value>{asdic::Lambert{}, asdic::EllisCrowe{}})
    EXPECT_NO_THROW(
        built().set("reverberation.enabled", true).set("reverberation.bottom", law).validate());
  const std::vector<asdic::Value> targets = {
      asdic::Target{.range = 2e3,
                    .bearing_deg = 30.0,
                    .depth = 50.0,
                    .velocity = {1.0, 0.0, 0.0},
                    .strength_db = 3.0,
                    .fluctuation = "swerling-1",
                    .scan_pings = 2},
      asdic::Target{.waypoints = {{0.0, {2e3, 0.0, 50.0}}, {60.0, {2e3, 90.0, 50.0}}},
                    .aspect = asdic::Aspect{5.0, 15.0, 3.0}}};
  for (const asdic::Value& target : targets)
    EXPECT_NO_THROW(built().erase("target").add("target", target).validate());
  EXPECT_NO_THROW(built()
                      .set("platform", asdic::Platform{.name = "ship",
                                                       .waypoints = {{0.0, {0.0, 0.0, 5.0}},
                                                                     {60.0, {90.0, 0.0, 5.0}}}})
                      .set("transmitter", asdic::Transmitter{.platform = "ship",
                                                             .source_level_db = 200.0,
                                                             .elevation_deg = -4.0,
                                                             .beamwidth_deg = 10.0})
                      .validate());
}

TEST(PublicUnits, AreSi) {
  EXPECT_DOUBLE_EQ(asdic::radians(180.0), 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(asdic::degrees(asdic::radians(77.0)), 77.0);
  EXPECT_DOUBLE_EQ(asdic::amplitude_from_db(20.0), 10.0);
  EXPECT_DOUBLE_EQ(asdic::power_from_db(20.0), 100.0);
  EXPECT_DOUBLE_EQ(asdic::db_from_amplitude(10.0), 20.0);
  EXPECT_DOUBLE_EQ(asdic::db_from_power(10.0), 10.0);
  EXPECT_THAT(asdic::build(), HasSubstr(asdic::version()));
}

TEST(PublicScenario, SaysWhatIsKnownByNow) {
  asdic::Scenario scenario = built();
  scenario.set("propagation.max_surface_bounces", 0).set("propagation.max_bottom_bounces", 0);
  EXPECT_THAT(scenario.warnings(), testing::IsEmpty());  // that takes a search for paths
  const std::vector<std::string> all = scenario.validate();
  EXPECT_THAT(all, Contains(HasSubstr("lacks the paths")));
  EXPECT_EQ(scenario.warnings(), all);
  EXPECT_EQ(asdic::Scenario(scenario).warnings(), all);  // a copy shares them
}

}  // namespace
