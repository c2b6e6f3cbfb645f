// Scenarios written as files: those of files, and those that a program makes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/settings_words.h"
#include "io/ping/ping_file.h"
#include "io/processing/recordings.h"
#include "io/scenario/scenario_reader.h"
#include "io/scenario/sections.h"
#include "io/scenario/writer.h"
#include "io/text/csv_table.h"
#include "sonar/ping/ping.h"
#include "support/ping_record.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

/// All that a scenario is beside its environment.
struct Sonar {
  Scenario& scenario;
  void describe(Fields& field) {
    scenario::describe_head(field, scenario);
    field("pulse", scenario.pulse, "");
    scenario::describe_bodies(field, scenario);
    scenario::describe_sound(field, scenario);
  }
};

void expect_same(Scenario a, Scenario b) {
  EXPECT_EQ(settings_words(Sonar{a}), settings_words(Sonar{b}));
  EXPECT_EQ(a.environment, b.environment);
  EXPECT_EQ(a.transect, b.transect);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.wind_speed, b.wind_speed);
  EXPECT_EQ(a.title, b.title);
}

// What is written of a scenario is read as that scenario, bit for bit.
void expect_kept(const Scenario& scenario) {
  SCOPED_TRACE(scenario.path);
  const std::string text = to_toml(scenario);
  const Scenario same = parse_scenario(text, "written.toml", {});
  expect_same(same, scenario);
  EXPECT_EQ(to_toml(same), text);
}

TEST(ScenarioWritten, EveryScenarioOfOursIsKept) {
  int sonars = 0;
  for (const auto& file : std::filesystem::directory_iterator(ASDIC_SCENARIOS)) {
    if (file.path().extension() != ".toml") continue;
    const TomlValue root = parse_toml(read_text_file(file.path(), "a scenario"), "");
    if (root.find("platform") == nullptr) continue;  // an ocean to be included, or a run
    expect_kept(read_scenario(file.path(), {}));
    ++sonars;
  }
  EXPECT_GE(sonars, 12);
}

TEST(ScenarioWritten, ElevationsOfPingsStandForThoseOfTheTransmitter) {
  Scenario scenario = support::small_scenario();
  scenario.transmitters[0].elevation = 0.1;
  EXPECT_EQ(parse_scenario(to_toml(scenario), "w.toml", {}).transmitters[0].elevation, 0.1);
  scenario.pings.elevations = {0.2, -0.1};
  EXPECT_EQ(parse_scenario(to_toml(scenario), "w.toml", {}).pings.elevations,
            scenario.pings.elevations);
}

TEST(ScenarioWritten, ATransmitterMayHaveAPulseOfItsOwn) {
  Scenario scenario = support::small_scenario();
  scenario.transmitters.push_back({.source_level_db = 210.0, .name = "other"});
  scenario.transmitters[1].pulse = PulseSettings{.waveform = Lfm{900.0, 1100.0}, .duration = 0.2};
  scenario.arrays.push_back({.phones = {Vec3(0.0, 1.0 / 3.0, 0.0)}, .name = "buoy"});
  scenario.arrays[1].electronics.gain_db = {0.1};
  expect_kept(scenario);
}

/// A scenario that no file has said.
Scenario made() {
  Scenario scenario = support::small_scenario();
  scenario.text.clear();
  scenario.path.clear();
  scenario.targets[0].strength_db = 1.0 / 3.0;
  SampledPulse pulse{.samples = {}, .sample_rate = 8000.0};
  for (int i = 0; i < 800; ++i) pulse.samples.push_back(std::sin(0.7 * i) * i * (800 - i));
  scenario.pulse = {.waveform = pulse, .duration = 0.1, .window = PulseWindow::none};
  return scenario;
}

TEST(ScenarioWritten, APulseThatWasMadeStandsInTheFile) {
  const Scenario scenario = made();
  expect_kept(scenario);
  const Scenario same = parse_scenario(to_toml(scenario), "written.toml", {});
  EXPECT_EQ(same.pulse, scenario.pulse);
}

// A ping file of a scenario that was made has a scenario, which makes the same pings again.
TEST(ScenarioWritten, APingFileHoldsTheScenarioThatWasMade) {
  const support::TemporaryDirectory folder;
  const Scenario scenario = made();
  const PingSimulator simulator(scenario);
  const PingRecord record = simulator.simulate(1);
  {
    PingFileWriter writer(folder / "p.h5", scenario, {.program_version = "0.1", .build = "g++"});
    writer.append(record);
    writer.finish(true);
  }
  EXPECT_EQ(PingFile(folder / "p.h5").scenario_text(), to_toml(scenario));
  const PingRecordings recordings(folder / "p.h5");
  expect_same(recordings.scenario(), scenario);
  EXPECT_EQ(PingSimulator(recordings.scenario()).simulate(1).pressure, record.pressure);
}

}  // namespace
}  // namespace asdic::detail
