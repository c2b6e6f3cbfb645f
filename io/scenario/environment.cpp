#include <algorithm>

#include "io/scenario/sections.h"

namespace asdic::scenario {
namespace {

BoundaryMaterial read_material(TomlTable& table, std::optional<std::string> fallback) {
  const std::string kind = table.choice("kind", {"vacuum", "rigid", "fluid"}, std::move(fallback));
  if (kind == Vacuum::name) return Vacuum{};
  if (kind == Rigid::name) return Rigid{};
  const FluidHalfSpace sand;
  return FluidHalfSpace{
      .speed = table.number("speed", speed_of_sound, sand.speed),
      .density = table.number(
          "density", {.noun = "density", .unit = "kg/m3", .low = 0.0, .above = true}, sand.density),
      .attenuation_db_per_wavelength = table.number(
          "attenuation_db_per_wavelength",
          {.noun = "attenuation", .unit = "dB per wavelength", .low = 0.0, .high = 20.0},
          sand.attenuation_db_per_wavelength)};
}

Absorption read_absorption(TomlTable table) {
  const std::string kind = table.choice("kind", {"none", "thorp", "francois-garrison"}, "thorp");
  Absorption absorption = NoAbsorption{};
  if (kind == Thorp::name) absorption = Thorp{};
  if (kind == FrancoisGarrison::name) {
    FrancoisGarrison law;
    law.temperature = table.number(
        "temperature", {.noun = "temperature", .unit = "degC", .low = -3.0, .high = 45.0},
        law.temperature);
    law.salinity = table.number(
        "salinity", {.noun = "salinity", .unit = "psu", .low = 0.0, .high = 50.0}, law.salinity);
    law.ph = table.number("ph", {.noun = "pH", .low = 6.0, .high = 9.0}, law.ph);
    law.depth = table.number("depth", depth_quantity, law.depth);
    absorption = law;
  }
  table.finish();
  return absorption;
}

/// Depth of the water: `depth`, or the transect's depth at range 0 (all that a flat bottom can
/// use).
double read_bottom_depth(TomlTable& bottom, Scenario& scenario) {
  constexpr Quantity positive{
      .noun = "depth", .unit = "m", .low = 0.0, .high = 12000.0, .above = true};
  if (!bottom.has("transect")) return bottom.number("depth", positive);
  TomlTable transect = bottom.table("transect");
  const auto range = transect.numbers("range", {.noun = "range", .unit = "m", .low = 0.0});
  const auto depth = transect.numbers("depth", positive);
  if (range.size() != depth.size())
    throw transect.fault("depth", "as many depths as ranges, " + std::to_string(range.size()));
  for (std::size_t i = 1; i < range.size(); ++i)
    if (range[i] <= range[i - 1])
      throw transect.fault("range[" + std::to_string(i) + "]",
                           "a range above the one before it, " + to_text(range[i - 1]) + " m");
  if (range.front() != 0.0) throw transect.fault("range[0]", "0 m, the place of the platform");
  static_cast<void>(transect.text("note", ""));
  transect.finish();
  const double used = bottom.number("depth", positive, depth.front());
  const auto [least, most] = std::minmax_element(depth.begin(), depth.end());
  scenario.notes.push_back("the bottom is taken as flat at " + to_text(used) +
                           " m; along environment.bottom.transect it lies between " +
                           to_text(*least) + " m and " + to_text(*most) + " m");
  return used;
}

}  // namespace

void read_environment(TomlTable table, const std::filesystem::path& folder, Scenario& scenario) {
  Environment& ocean = scenario.environment;
  scenario.wind_speed =
      table.number("wind_speed", {.noun = "wind speed", .unit = "m/s", .low = 0.0, .high = 60.0},
                   scenario.wind_speed);
  ocean.water_density = table.number(
      "water_density", {.noun = "density", .unit = "kg/m3", .low = 500.0, .high = 2000.0},
      ocean.water_density.at(0.0));

  TomlTable bottom = table.table("bottom");
  ocean.bottom.depth = read_bottom_depth(bottom, scenario);
  ocean.bottom.material = read_material(bottom, std::nullopt);
  bottom.finish();

  TomlTable surface = table.table("surface");
  ocean.surface.material = read_material(surface, std::string(Vacuum::name));
  surface.finish();

  ocean.absorption = read_absorption(table.table("absorption"));
  ocean.water =
      read_sound_speed(table.table("sound_speed"), folder, ocean.bottom.depth, scenario.notes);
  table.finish();
}

}  // namespace asdic::scenario
