#include "io/scenario_reader.h"

#include "io/scenario/sections.h"
#include "io/text/csv_table.h"
#include "io/text/quote.h"
#include "io/text/toml_table.h"

namespace asdic {
namespace {

/// `include = "ocean.toml"`: a file with an [environment] and nothing else, whose values stand
/// where the scenario gives none.
void merge_include(TomlValue& root, const std::filesystem::path& folder) {
  const TomlValue* include = root.find("include");
  if (include == nullptr) return;
  TomlTable reader(root);
  const std::filesystem::path path = folder / reader.text("include");
  if (!std::filesystem::exists(path))
    throw reader.fault("include", "a TOML file with an [environment]",
                       "no such file " + in_quotes(path.string()));
  TomlValue fragment = parse_toml(read_text_file(path), path.string());
  for (const TomlEntry& entry : std::get<TomlValue::Table>(fragment.data))
    if (entry.key != "environment")
      throw InputError({.where = entry.value.origin + ": " + entry.key,
                        .got = "a key of the whole scenario in an included file",
                        .expected = "[environment] alone"});
  // A file named by the fragment is relative to the fragment.
  if (TomlValue* environment = fragment.find("environment"))
    if (TomlValue* sound_speed = environment->find("sound_speed"))
      if (TomlValue* file = sound_speed->find("file"))
        if (const auto* name = std::get_if<std::string>(&file->data))
          file->data = std::filesystem::absolute(path.parent_path() / *name).string();
  merge_defaults(root, fragment);
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& path, std::span<const std::string> overrides) {
  return parse_scenario(read_text_file(path, "a scenario file"), path, overrides);
}

Scenario parse_scenario(std::string_view text, const std::filesystem::path& path,
                        std::span<const std::string> overrides) {
  const std::filesystem::path folder = path.parent_path();
  TomlValue document = parse_toml(text, path.string());
  for (const std::string& assignment : overrides)  // which file to include comes first …
    if (assignment.starts_with("include=")) apply_override(document, assignment);
  merge_include(document, folder);
  for (const std::string& assignment : overrides)  // … for the others may change what it says
    apply_override(document, assignment);

  Scenario scenario;
  scenario.text = text;
  scenario.path = path.string();
  scenario.overrides.assign(overrides.begin(), overrides.end());

  TomlTable root(document);
  static_cast<void>(root.has("include"));
  scenario.title = root.text("title", "");
  scenario.seed = static_cast<std::uint64_t>(
      root.integer("seed", 0, std::numeric_limits<std::int64_t>::max(), 1));
  scenario::read_environment(root.table("environment"), folder, scenario);
  scenario::read_platform(root.table("platform"), scenario);
  TomlTable transmitter = root.table("transmitter");
  const bool has_elevation = transmitter.has("elevation_deg");
  scenario::read_transmitter(std::move(transmitter), scenario);
  scenario::read_pulse(root.table("pulse"), folder, scenario);
  scenario::read_array(root.table("array"), scenario);
  scenario::read_targets(root.tables("target"), scenario);
  scenario::read_noise(root.table("noise"), scenario);
  scenario::read_reverberation(root.table("reverberation"), scenario);
  scenario::read_propagation(root.table("propagation"), scenario);
  scenario::read_pings(root.table("pings"), has_elevation, scenario);
  root.finish();
  scenario::check_scenario(root, scenario);
  return scenario;
}

}  // namespace asdic
