#include <cmath>
#include <type_traits>
#include <utility>

#include "io/scenario/sections.h"

namespace asdic::scenario {
namespace {

/// The law of the list whose name was chosen, with its parameters as `describe` lists them.
template <std::size_t... I>
AnySurfaceScattering read_law(TomlTable& table, std::index_sequence<I...>) {
  std::vector<std::string> names{
      std::string(std::variant_alternative_t<I, AnySurfaceScattering>::name)...};
  const std::string kind = table.choice("kind", names, names.front());
  AnySurfaceScattering law;
  const auto read = [&]<class Model>(Model model) {
    if (kind != Model::name) return;
    model.describe([&](const char* key, double& value, const Range& range) {
      value = table.number(key, {.low = range.low, .high = range.high}, value);
    });
    law = model;
  };
  (read(std::variant_alternative_t<I, AnySurfaceScattering>{}), ...);
  return law;
}

}  // namespace

void read_reverberation(TomlTable table, Scenario& scenario) {
  ReverberationSettings& settings = scenario.reverberation;
  settings.enabled = table.flag("enabled", settings.enabled);
  settings.azimuths = static_cast<int>(table.integer("azimuths", 1, 3600, settings.azimuths));
  if (table.has("ground_spacing"))
    settings.ground_spacing =
        table.number("ground_spacing", {.noun = "spacing", .unit = "m", .low = 0.01, .high = 1e5});
  TomlTable surface = table.table("surface");
  settings.surface =
      read_law(surface, std::make_index_sequence<std::variant_size_v<AnySurfaceScattering>>{});
  surface.finish();
  table.finish();
  std::visit(
      [&](auto& law) {
        law.wind_speed = scenario.wind_speed;
        law.sound_speed = scenario.environment.water.at(scenario.environment.surface.depth).c;
      },
      settings.surface);
}

}  // namespace asdic::scenario
