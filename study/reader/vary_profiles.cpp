#include "study/reader/vary_profiles.h"

#include <algorithm>
#include <set>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"

namespace asdic::detail::study {
namespace {

/// Modes out of the file itself or of a CSV file with columns depth, mode_1, mode_2, …
struct GivenModes {
  std::vector<double> depth;
  std::vector<std::vector<double>> modes;  // [modes][levels]
};

GivenModes read_given(TomlTable& table, const std::filesystem::path& folder) {
  GivenModes given;
  if (table.has("file")) {
    const std::filesystem::path path = folder / table.text("file");
    if (!std::filesystem::exists(path))
      throw table.fault("file", "a CSV file", "no such file " + in_quotes(path.string()));
    const CsvTable csv = read_csv(path);
    given.depth = csv.column("depth");
    for (int k = 1; csv.has("mode_" + std::to_string(k)); ++k)
      given.modes.push_back(csv.column("mode_" + std::to_string(k)));
    if (given.modes.empty())
      throw table.fault("file", "columns depth, mode_1, mode_2, …", "no column mode_1");
  } else {
    given.depth = table.numbers("depth", quantity::depth);
    given.modes = table.rows("modes", {.noun = "number"});
    if (given.modes.front().size() != given.depth.size())
      throw table.fault(
          "modes[0]", "a number for each of the " + std::to_string(given.depth.size()) + " depths");
  }
  for (std::size_t i = 1; i < given.depth.size(); ++i)
    if (!(given.depth[i] > given.depth[i - 1]))
      throw table.fault(table.has("file") ? "file" : "depth[" + std::to_string(i) + "]",
                        "a depth below the one before it, " + to_text(given.depth[i - 1]) + " m");
  return given;
}

/// Straight between the levels, constant beyond them.
double at(const std::vector<double>& depth, const std::vector<double>& values, double z) {
  const auto it = std::upper_bound(depth.begin(), depth.end(), z);
  if (it == depth.begin()) return values.front();
  if (it == depth.end()) return values.back();
  const auto i = static_cast<std::size_t>(it - depth.begin());
  return std::lerp(values[i - 1], values[i], (z - depth[i - 1]) / (depth[i] - depth[i - 1]));
}

/// The levels of the profile that is perturbed: those of its own table, if it has them there.
std::vector<double> own_levels(const TomlValue& profile) {
  std::vector<double> levels;
  if (const TomlValue* depth = profile.find("depth"))
    if (const auto* items = std::get_if<TomlValue::Array>(&depth->data))
      for (const TomlValue& item : *items)
        if (const std::optional<double> z = number_of(item)) levels.push_back(*z);
  return levels;
}

}  // namespace

ModesLaw read_modes(TomlTable& table, const Study& study) {
  const Scenario scenario = scenario_of(study.scenario, study.scenario_path);
  if (scenario.environment.section)
    throw table.fault("law", "a profile of depth alone, no section, to perturb",
                      "\"profile_eof\" of a section");
  const GivenModes given = read_given(table, study.path.parent_path());
  ModesLaw law;
  const std::vector<double> deviations =
      table.numbers("deviations", {.noun = "deviation", .unit = "m/s", .low = 0.0, .above = true});
  if (deviations.size() != given.modes.size())
    throw table.fault("deviations", "a deviation for each of the " +
                                        std::to_string(given.modes.size()) + " modes");
  const double most = table.number("most_deviations", {.low = 0.0, .above = true}, infinity);
  for (const double deviation : deviations)
    law.amplitudes.emplace_back(Normal{0.0, deviation}, -most * deviation, most * deviation);

  const TomlValue* profile = nullptr;
  if (const TomlValue* environment = study.scenario.find("environment"))
    profile = environment->find("sound_speed");
  std::set<double> levels(given.depth.begin(), given.depth.end());
  law.interpolation = "c-linear";
  if (profile != nullptr) {
    for (const double z : own_levels(*profile)) levels.insert(z);
    if (const TomlValue* text = profile->find("interpolation"))
      if (const auto* name = std::get_if<std::string>(&text->data)) law.interpolation = *name;
  }
  levels.insert(scenario.environment.surface.shape ? 0.0 : scenario.environment.surface.depth);
  levels.insert(scenario.environment.bottom.shape ? scenario.environment.bottom.shape->deepest()
                                                  : scenario.environment.bottom.depth);
  law.depth.assign(levels.begin(), levels.end());
  for (const double z : law.depth) law.mean.push_back(scenario.environment.water.at(z).c);
  for (const std::vector<double>& mode : given.modes) {
    law.modes.emplace_back();
    for (const double z : law.depth) law.modes.back().push_back(at(given.depth, mode, z));
  }
  return law;
}

ChoiceLaw read_casts(TomlTable& table, const TomlValue& value, const Variable& variable,
                     const Study& study) {
  ChoiceLaw law;
  std::vector<std::string> names;
  const std::string interpolation =
      table.choice("interpolation", {"c-linear", "n2-linear", "spline", "pchip"}, "c-linear");
  const TomlValue* given = table.has("casts") ? value.find("casts") : nullptr;
  const auto* items = given == nullptr ? nullptr : std::get_if<TomlValue::Array>(&given->data);
  if (items == nullptr || items->empty())
    throw table.fault("casts", "an array of CSV files, or of tables with depth and speed");
  for (std::size_t i = 0; i < items->size(); ++i) {
    const TomlValue& item = (*items)[i];
    const auto text = [&](const std::string& word) {
      return TomlValue{.data = word, .origin = item.origin};
    };
    TomlValue::Table cast;
    if (const auto* file = std::get_if<std::string>(&item.data)) {
      const std::filesystem::path path =
          std::filesystem::absolute(study.path.parent_path() / *file);
      if (!std::filesystem::exists(path))
        throw table.fault("casts[" + std::to_string(i) + "]", "a CSV file",
                          "no such file " + in_quotes(path.string()));
      // Read once, not for every realisation.
      const CsvTable csv = read_csv(path);
      for (const char* name : {"depth", "speed"}) {
        TomlValue::Array column;
        for (const double x : csv.column(name))
          column.push_back({.data = x, .origin = item.origin});
        cast.push_back({name, {.data = std::move(column), .origin = item.origin}});
      }
      names.push_back(path.stem().string());
    } else if (const TomlValue::Table* own = item.table()) {
      cast = *own;
      names.push_back(std::to_string(i + 1));
    } else {
      throw table.fault("casts[" + std::to_string(i) + "]",
                        "a CSV file, or a table with depth and speed");
    }
    const TomlValue made{.data = cast, .origin = item.origin};
    if (made.find("kind") == nullptr) cast.push_back({"kind", text("table")});
    if (made.find("interpolation") == nullptr)
      cast.push_back({"interpolation", text(interpolation)});
    law.values.push_back({{.data = std::move(cast), .origin = variable.origin}});
  }
  law.labels.push_back(std::move(names));
  return law;
}

}  // namespace asdic::detail::study
