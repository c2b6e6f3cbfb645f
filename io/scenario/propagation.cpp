#include "io/scenario/propagation.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "io/scenario/area.h"
#include "io/scenario/document.h"
#include "io/scenario/ocean.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "raytrace/ocean/slice.h"
#include "raytrace/warnings/warnings.h"

namespace asdic::detail {
namespace {

/// What the propagation model is to do. \throws InputError where nothing says so
TomlTable run_of(TomlTable& root) {
  if (!root.has("run"))
    throw root.fault("run",
                     "a [run] with [run.receivers]: what the propagation model is to do "
                     "(docs/formats/scenario.md)");
  return root.table("run");
}

/// What lies beyond the map of an area that a run goes to.
void tell_beyond_the_map(const PropagationCase& run, std::vector<std::string>& notes) {
  if (!run.on_area) return;
  double furthest = run.box_range;
  for (const double range : run.receivers.ranges) furthest = std::max(furthest, range);
  if (furthest > reach_of_area)
    notes.push_back("environment.area: sound is followed to " + to_text(furthest / 1000.0) +
                    " km, and planes are taken out of the maps to " +
                    to_text(reach_of_area / 1000.0) + " km; from there the floor goes on level");
  const double reach = reach_on_map(run, furthest);
  if (reach < furthest)
    notes.push_back("environment.area: sound is followed to " + to_text(furthest / 1000.0) +
                    " km, and the maps end " + to_text(std::round(reach) / 1000.0) +
                    " km away; beyond them their edge goes on");
}

/// A file with an ocean and a run, and no sonar.
PropagationCase of_ocean_and_run(const TomlValue& document, const std::filesystem::path& folder,
                                 std::vector<std::string>& notes, NotedSettings* noted) {
  TomlTable root(document);
  root.note_in(noted);
  static_cast<void>(root.has("include"));
  PropagationCase run;
  run.title = root.text("title", "");
  run.source_depths.clear();
  TomlTable table = run_of(root);
  run.frequency =
      table.number("frequency", {.noun = "frequency", .unit = "Hz", .low = 1e-3, .high = 1e8});
  TomlTable environment = root.table("environment");
  static_cast<void>(environment.has("wind_speed"));  // of a sonar
  run.origin = scenario::read_origin(environment);
  scenario::OceanReading reading{.folder = folder, .frequency = run.frequency, .notes = notes};
  std::optional<scenario::AreaReading> area = scenario::read_area(environment, reading, run.origin);
  if (area) reading.area = &*area;
  run.environment = scenario::read_ocean(environment, reading);
  const bool along = environment.has("transect");
  const Transect transect = scenario::read_transect(environment);
  if (area) {
    run.on_area = {.area = area->build(run.environment, transect),
                   .place = Vec2(transect.x, transect.y),
                   .bearing = transect.bearing};
    run.environment =
        run.on_area->area->section(run.on_area->place, run.on_area->bearing, reach_of_area);
  }
  if (area || along || varies_with_range(run.environment)) run.on_map = transect;
  environment.finish();
  scenario::read_run(std::move(table), run);
  root.finish();
  tell_beyond_the_map(run, notes);
  add_warnings(warnings(run), notes);
  return run;
}

/// The ocean, source and frequency of a sonar scenario, which has been read and checked as one.
PropagationCase of_sonar(const TomlValue& document, const Scenario& scenario,
                         std::vector<std::string>& notes) {
  notes.insert(notes.end(), scenario.notes.begin(), scenario.notes.end());
  const Vec3 platform = scenario.platforms[0].track.at(0.0).position;
  PropagationCase run;
  run.title = scenario.title;
  run.origin = scenario.origin;
  run.environment =
      ocean_on_map(scenario).plane(platform.head<2>(), scenario.transect.bearing, reach_of_area);
  if (scenario.area)
    run.on_area = {
        .area = scenario.area, .place = platform.head<2>(), .bearing = scenario.transect.bearing};
  if (scenario.area || varies_with_range(scenario.environment))
    run.on_map = {.x = platform.x(), .y = platform.y(), .bearing = scenario.transect.bearing};
  run.frequency = Pulse(scenario.pulse).centre_frequency();
  run.source_depths = {platform.z()};
  TomlTable root(document);
  scenario::read_run(run_of(root), run);
  tell_beyond_the_map(run, notes);
  add_warnings(warnings(run), notes);
  return run;
}

}  // namespace

PropagationCase read_propagation_case(const std::filesystem::path& path,
                                      std::span<const std::string> overrides,
                                      std::vector<std::string>& notes) {
  return parse_propagation_case(read_text_file(path, "a scenario file"), path, overrides, notes);
}

MemoryBudget read_budget(const std::filesystem::path& path,
                         std::span<const std::string> overrides) {
  return budget_of(
      scenario::read_document(read_text_file(path, "a scenario file"), path, overrides));
}

MemoryBudget budget_of(const TomlValue& document, MemoryBudget otherwise) {
  const TomlValue* run = document.find("run");
  if (run == nullptr) return otherwise;
  TomlTable table(*run, "run");
  const double bytes = scenario::read_memory(table);
  return bytes > 0.0 ? MemoryBudget::of(bytes) : otherwise;
}

bool has_sonar(const std::filesystem::path& path, std::span<const std::string> overrides) {
  return has_sonar(
      scenario::read_document(read_text_file(path, "a scenario file"), path, overrides));
}

bool has_sonar(const TomlValue& document) {
  return document.find("platform") != nullptr || document.find("run") == nullptr;
}

bool asks_for_rays(const std::filesystem::path& path, std::span<const std::string> overrides) {
  const TomlValue document =
      scenario::read_document(read_text_file(path, "a scenario file"), path, overrides);
  const TomlValue* run = document.find("run");
  const TomlValue* task = run == nullptr ? nullptr : run->find("task");
  if (task == nullptr) return false;
  const auto* text = std::get_if<std::string>(&task->data);
  return text != nullptr && (*text == word_of(Task::rays) || *text == word_of(Task::eigenrays) ||
                             *text == word_of(Task::eigenrays_and_arrivals));
}

InputError told_of_scenario(const InputError& error, const std::filesystem::path& path,
                            std::span<const std::string> overrides) {
  return told_of_scenario(
      error, scenario::read_document(read_text_file(path, "a scenario file"), path, overrides),
      path);
}

InputError told_of_scenario(const InputError& error, const TomlValue& document,
                            const std::filesystem::path& path) {
  InputFault fault = error.fault();
  const std::pair<std::string_view, std::string_view> names[] = {
      {"beams.highest", "run.fan.highest"},
      {"beams.elevations", "run.fan.elevations"},
      {"beams.count", "run.fan.count"},
      {"solver", "run.solver"},
      {"source_depths", "run.source.depth"},
      {"source depths", "run.source.depth"},
      {"receivers.depths", "run.receivers.depth"},
      {"receivers", "run.receivers"},
      {"frequency", "run.frequency"},
      {"box", "run.box_range"}};
  for (const auto& [ours, theirs] : names)
    if (fault.where.starts_with(ours)) {
      fault.where.replace(0, ours.size(), theirs);
      break;
    }
  std::string origin = path.string();
  const TomlValue* value = &document;  // as deep as the file goes
  for (std::string_view rest = fault.where; !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of(".["), rest.size());
    const std::string key(rest.substr(0, end));
    const TomlValue* next = value->find(key);
    for (const char* unit : {"_deg", "_rad"})
      if (next == nullptr) next = value->find(key + unit);
    if (next == nullptr) break;
    value = next;
    origin = value->origin;
    rest.remove_prefix(end);
    if (rest.empty() || rest.front() != '.') break;
    rest.remove_prefix(1);
  }
  fault.where = origin + ": " + fault.where;
  return InputError(std::move(fault));
}

PropagationCase parse_propagation_case(std::string_view text, const std::filesystem::path& path,
                                       std::span<const std::string> overrides,
                                       std::vector<std::string>& notes) {
  return propagation_case_of(scenario::read_document(text, path, overrides), path, notes);
}

PropagationCase propagation_case_of(const TomlValue& document, const std::filesystem::path& path,
                                    std::vector<std::string>& notes, NotedSettings* noted) {
  if (document.find("platform") != nullptr)
    return of_sonar(document, scenario_of(document, path, noted), notes);
  return of_ocean_and_run(document, path.parent_path(), notes, noted);
}

}  // namespace asdic::detail
