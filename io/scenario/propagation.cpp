#include "io/scenario/propagation.h"

#include "io/scenario/document.h"
#include "io/scenario/ocean.h"
#include "io/scenario_reader.h"
#include "io/text/csv_table.h"
#include "raytrace/ocean/slice.h"

namespace asdic {
namespace {

/// A file with an ocean and a run, and no sonar.
PropagationCase of_ocean_and_run(const TomlValue& document, const std::filesystem::path& folder,
                                 std::vector<std::string>& notes) {
  TomlTable root(document);
  static_cast<void>(root.has("include"));
  PropagationCase run;
  run.title = root.text("title", "");
  run.source_depths.clear();
  TomlTable table = root.table("run");
  run.frequency = table.number(
      "frequency", {.noun = "frequency", .unit = "Hz", .low = 0.0, .high = 1e8, .above = true});
  TomlTable environment = root.table("environment");
  for (const char* of_a_sonar : {"wind_speed", "transect"})
    static_cast<void>(environment.has(of_a_sonar));
  run.environment = scenario::read_ocean(
      environment, {.folder = folder, .frequency = run.frequency, .notes = notes});
  environment.finish();
  scenario::read_run(std::move(table), run);
  root.finish();
  return run;
}

/// The ocean, source and frequency of a sonar scenario, which has been read and checked as one.
PropagationCase of_sonar(const TomlValue& document, const Scenario& scenario,
                         std::vector<std::string>& notes) {
  notes.insert(notes.end(), scenario.notes.begin(), scenario.notes.end());
  const Vec3 platform = scenario.platforms[0].track.at(0.0).position;
  PropagationCase run;
  run.title = scenario.title;
  run.environment =
      slice(scenario.environment, scenario.transect.range_of(platform.x(), platform.y()), 1.0);
  run.frequency = Pulse(scenario.pulse).centre_frequency();
  run.source_depths = {platform.z()};
  TomlTable root(document);
  scenario::read_run(root.table("run"), run);
  return run;
}

}  // namespace

PropagationCase read_propagation_case(const std::filesystem::path& path,
                                      std::span<const std::string> overrides,
                                      std::vector<std::string>& notes) {
  return parse_propagation_case(read_text_file(path, "a scenario file"), path, overrides, notes);
}

bool has_sonar(const std::filesystem::path& path, std::span<const std::string> overrides) {
  const TomlValue document =
      scenario::read_document(read_text_file(path, "a scenario file"), path, overrides);
  return document.find("platform") != nullptr || document.find("run") == nullptr;
}

PropagationCase parse_propagation_case(std::string_view text, const std::filesystem::path& path,
                                       std::span<const std::string> overrides,
                                       std::vector<std::string>& notes) {
  const TomlValue document = scenario::read_document(text, path, overrides);
  if (document.find("platform") != nullptr)
    return of_sonar(document, parse_scenario(text, path, overrides), notes);
  return of_ocean_and_run(document, path.parent_path(), notes);
}

}  // namespace asdic
