#include "io/scenario/scenario_reader.h"

#include <algorithm>

#include "io/scenario/checks.h"
#include "io/scenario/document.h"
#include "io/scenario/embedded.h"
#include "io/scenario/propagation.h"
#include "io/scenario/sections.h"
#include "io/settings/reader.h"
#include "io/text/csv_table.h"
#include "io/text/toml_table.h"
#include "io/text/toml_value.h"
#include "sonar/warnings/warnings.h"

namespace asdic::detail {
namespace {

/// run.memory (read_budget()), and for `asdic field` the rest: checked, and of no use to a ping.
void read_run_of_sonar(TomlTable table, const TomlValue& value, double frequency,
                       const Scenario& scenario) {
  const auto* const keys = value.table();
  const bool alone = scenario::read_memory(table) > 0.0 && keys != nullptr && keys->size() == 1;
  if (alone) return;
  PropagationCase run;
  run.environment = scenario.environment;
  run.frequency = frequency;
  run.source_depths = {scenario.platforms[0].track.at(0.0).position.z()};
  scenario::read_run(std::move(table), run);
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& path, std::span<const std::string> overrides) {
  return parse_scenario(read_text_file(path, "a scenario file"), path, overrides);
}

namespace {

Scenario scenario_of(const TomlValue& document, std::string_view text,
                     const std::filesystem::path& path, std::span<const std::string> overrides) {
  Scenario scenario = scenario_of(document, path);
  scenario.text = text;
  scenario.overrides.assign(overrides.begin(), overrides.end());
  return scenario;
}

}  // namespace

Scenario parse_scenario(std::string_view text, const std::filesystem::path& path,
                        std::span<const std::string> overrides) {
  return scenario_of(scenario::read_document(text, path, overrides), text, path, overrides);
}

Scenario parse_embedded_scenario(std::string_view text, const std::filesystem::path& path,
                                 std::span<const std::string> overrides) {
  const std::filesystem::path folder = path.parent_path();
  const std::string remedy = "--scenario names the scenario's own file";
  scenario::check_names(parse_toml(text, path.string()), folder, remedy);
  scenario::check_names(overrides, folder, remedy);
  const TomlValue document = scenario::read_document(text, path, overrides);
  scenario::check_names(document, folder, remedy);  // with what it includes
  return scenario_of(document, text, path, overrides);
}

Scenario scenario_of(const TomlValue& document, const std::filesystem::path& path,
                     NotedSettings* noted) {
  const std::filesystem::path folder = path.parent_path();
  Scenario scenario;
  scenario.path = path.string();

  TomlTable root(document);
  root.note_in(noted);
  static_cast<void>(root.has("include"));
  if (document.find("study") != nullptr)
    throw root.fault("study", "a scenario; asdic study makes the realisations of a study",
                     "a study");
  if (root.has("run") && !root.has("platform"))
    throw root.fault("platform",
                     "a sonar: [platform], [pulse], [array], …; for the propagation "
                     "model alone: asdic field, rays or arrivals",
                     "[run] and no sonar");
  KnownSettings known{.folder = folder};
  TomlReader settings(root, known);
  scenario::describe_head(settings, scenario);
  std::vector<TomlTable> transmitters = root.one_or_more("transmitter");
  const bool own_pulses = std::all_of(transmitters.begin(), transmitters.end(),
                                      [](TomlTable& table) { return table.has("pulse"); });
  TomlTable& of_pulse = own_pulses && !root.has("pulse") ? transmitters[0] : root;
  read_settings(of_pulse.table("pulse"), scenario.pulse, known);
  const Pulse pulse(scenario.pulse);
  const double frequency = pulse.centre_frequency();
  scenario::read_environment(root.table("environment"), folder, frequency, scenario);
  const bool has_elevation = std::any_of(
      transmitters.begin(), transmitters.end(),
      [](TomlTable& table) { return table.has("elevation_deg") || table.has("elevations_deg"); });
  settings.know("transmitter.has_elevation", has_elevation ? 1.0 : 0.0);
  scenario::describe_bodies(settings, scenario);
  scenario::check_coherence(root.table("noise"), scenario);
  scenario::describe_sound(settings, scenario);
  if (const TomlValue* run = document.find("run"); root.has("run"))
    read_run_of_sonar(root.table("run"), *run, frequency, scenario);
  root.finish();
  scenario::check_scenario(root, scenario);
  scenario.notes.insert(scenario.notes.end(), known.notes.begin(), known.notes.end());
  add_warnings(warnings(scenario), scenario.notes);
  return scenario;
}

}  // namespace asdic::detail
