#include <algorithm>
#include <cmath>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/angles.h"
#include "io/scenario/ocean.h"
#include "io/scenario/sections.h"

namespace asdic {

std::string_view name(Spreading spreading) noexcept {
  return spreading == Spreading::plane ? "plane" : "cylindrical";
}

namespace scenario {
namespace {

const double default_wind_speed = Scenario{}.wind_speed;

/// Ranges at which two boundaries can be nearest: all nodes, and places between where one is
/// curved.
std::vector<double> places_to_look(const Environment& ocean) {
  std::vector<double> ranges = {0.0};
  for (const Boundary* boundary : {&ocean.surface, &ocean.bottom}) {
    if (!boundary->shape) continue;
    const auto nodes = boundary->shape->ranges();
    ranges.insert(ranges.end(), nodes.begin(), nodes.end());
    constexpr int between = 8;
    if (boundary->shape->interpolation() == ShapeInterpolation::smooth)
      for (std::size_t i = 1; i < nodes.size(); ++i)
        for (int k = 1; k < between; ++k)
          ranges.push_back(std::lerp(nodes[i - 1], nodes[i], double(k) / between));
  }
  return ranges;
}

/// The bottom is nowhere above the surface, and somewhere below it.
void check_water(TomlTable& bottom, const Environment& ocean) {
  double most = 0.0;
  for (const double range : places_to_look(ocean)) {
    const double surface = ocean.surface.depth_at(range), floor = ocean.bottom.depth_at(range);
    most = std::max(most, floor - surface);
    if (floor < surface)
      throw bottom.fault(bottom.has("depth") ? "depth" : "shape",
                         "a bottom below the surface, which is at " + to_text(surface) + " m there",
                         "a depth of " + to_text(floor) + " m at range " + to_text(range) + " m");
  }
  if (!(most > 0.0))
    throw bottom.fault(bottom.has("depth") ? "depth" : "shape", "water between it and the surface",
                       "none");
}

/// `roughness` [m], or "wind": the wind's sea; its spectrum is known. `bubbles`: under it.
void read_roughness(TomlTable& table, double wind_speed, bool surface, Boundary& boundary) {
  Roughness& rough = boundary.roughness;
  if (surface && table.is_text("roughness")) {
    table.choice("roughness", {"wind"});
    rough.rms_height = pierson_moskowitz_height(wind_speed);
    rough.sea_wind = wind_speed;
  } else {
    rough.rms_height = table.number(
        "roughness", {.noun = "rms height", .unit = "m", .low = 0.0, .high = 20.0}, 0.0);
    if (table.has("roughness"))
      rough.sea_wind = table.number("roughness_wind", quantity::wind_speed, rough.sea_wind);
  }
  constexpr Quantity floor{.noun = "floor", .unit = "dB", .low = -300.0, .high = 0.0};
  if (table.has("roughness"))  // what leaves the mean field is not lost: no floor is wanted
    rough.floor_db = table.number("roughness_floor_db", floor, floor.low);
  if (surface && table.choice("bubbles", {"none", "apl-uw"}, "none") == "apl-uw")
    rough.bubble_wind = table.number("bubbles_wind", quantity::wind_speed, wind_speed);
}

Transect read_transect(TomlTable table) {
  Transect transect;
  if (table.has("origin")) {
    const auto origin = table.numbers("origin", quantity::coordinate);
    if (origin.size() != 2) throw table.fault("origin", "[east, north] in m");
    transect.x = origin[0];
    transect.y = origin[1];
  }
  transect.bearing =
      read_angle(table, "bearing", {.noun = "bearing", .low_deg = -360.0, .high_deg = 360.0}, 0.0);
  table.finish();
  return transect;
}

}  // namespace

Environment read_ocean(TomlTable& table, const OceanReading& reading) {
  Environment ocean;
  TomlTable bottom = table.table("bottom"), surface = table.table("surface");
  ocean.bottom = read_boundary_place(bottom, reading, false);
  ocean.surface = read_boundary_place(surface, reading, true);
  check_water(bottom, ocean);
  read_water_losses(table, reading, ocean);
  read_sound_speed(table.table("sound_speed"), reading, ocean);
  read_boundary_materials(bottom, reading, ocean, std::nullopt, ocean.bottom);
  const double wind = table.number("wind_speed", quantity::wind_speed, default_wind_speed);
  read_roughness(bottom, wind, false, ocean.bottom);
  bottom.finish();
  read_boundary_materials(surface, reading, ocean, std::string(Vacuum::name), ocean.surface);
  read_roughness(surface, wind, true, ocean.surface);
  surface.finish();
  const std::string cylindrical(name(Spreading::cylindrical)), plane(name(Spreading::plane));
  if (table.choice("spreading", {plane, cylindrical}, plane) == cylindrical)
    ocean.spreading = Spreading::cylindrical;
  return ocean;
}

void read_environment(TomlTable table, const std::filesystem::path& folder, double frequency,
                      Scenario& scenario) {
  scenario.wind_speed = table.number("wind_speed", quantity::wind_speed, scenario.wind_speed);
  scenario.transect = read_transect(table.table("transect"));
  scenario.environment =
      read_ocean(table, {.folder = folder, .frequency = frequency, .notes = scenario.notes});
  table.finish();
}

}  // namespace scenario
}  // namespace asdic
