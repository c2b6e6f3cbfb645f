// Part of ocean.h and sections.h: [environment] as a whole.
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/area.h"
#include "io/scenario/ocean.h"
#include "io/scenario/sections.h"
#include "io/settings/reader.h"

namespace asdic::detail {

namespace scenario {
namespace {

/// Of a scenario that says nothing [m/s].
double default_wind_speed() { return std::make_unique<const Scenario>()->wind_speed; }

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

/// [environment.transect]
struct TransectTable {
  Transect transect = {};

  void describe(Fields& field) {
    std::vector<double> origin = {transect.x, transect.y};
    field("origin", origin, quantity::coordinate, "of range 0 on the map");
    if (field.checks() && origin.size() != 2) field.fault("origin", "[east, north] in m");
    transect.x = origin[0];
    transect.y = origin[1];
    field("bearing", transect.bearing, quantity::bearing, "true, of growing range");
  }
};

void describe_wind(Fields& field, double& wind_speed) {
  field(live("wind_speed"), wind_speed, quantity::wind_speed, "at 10 m height");
}

/// That of the map's [0, 0], where there is a map of it.
double read_wind(TomlTable& table, const AreaReading* area) {
  if (const auto mapped = area != nullptr ? area->wind_speed(0.0, 0.0) : std::nullopt) {
    if (table.has("wind_speed"))
      throw table.fault("wind_speed", "none beside [environment.area.wind], which says it");
    return *mapped;
  }
  double wind = default_wind_speed();
  KnownSettings known;
  TomlReader reader(table, known);
  describe_wind(reader, wind);
  return wind;
}

constexpr std::string_view what_origin = "where on the Earth the map's [0, 0] is";

void describe_spreading(Fields& field, Spreading& spreading) {
  field("spreading", spreading, "what the sea is beside the plane");
}

/// At the map's [0, 0].
SoundSpeedProfile water_at_origin(const WaterMap& water) {
  const auto depths = water.depths().places();
  return SoundSpeedProfile::table(depths, water.column(0.0, 0.0, depths), Interpolation::c_linear);
}

}  // namespace

Transect read_transect(TomlTable& table) {
  KnownSettings known;
  TomlReader reader(table, known);
  TransectTable transect;
  reader("transect", transect, "where the ocean's range axis lies on the map");
  return transect.transect;
}

std::optional<OceanOrigin> read_origin(TomlTable& table) {
  KnownSettings known;
  TomlReader reader(table, known);
  std::optional<OceanOrigin> origin;
  reader("origin", origin, what_origin);
  return origin;
}

std::optional<AreaReading> read_area(TomlTable& table, const OceanReading& reading,
                                     const std::optional<OceanOrigin>& origin) {
  if (!table.has("area")) return std::nullopt;
  return AreaReading(table.table("area"), reading, origin);
}

Environment read_ocean(TomlTable& table, const OceanReading& reading) {
  Environment ocean;
  TomlTable bottom = table.table("bottom"), surface = table.table("surface");
  ocean.bottom = read_boundary_place(bottom, reading, false);
  ocean.surface = read_boundary_place(surface, reading, true);
  check_water(bottom, ocean);
  KnownSettings known{.folder = reading.folder};
  TomlReader reader(table, known);
  describe_density(reader, ocean);
  describe_losses(reader, ocean);
  if (reading.area != nullptr && reading.area->water()) {
    if (table.has("sound_speed"))
      throw table.fault("sound_speed", "none beside [environment.area.sound_speed], which says it",
                        "[environment.sound_speed]");
    ocean.water = water_at_origin(*reading.area->water());
  } else {
    read_sound_speed(table.table("sound_speed"), reading, ocean);
  }
  read_boundary_materials(bottom, reading, ocean, false, ocean.bottom);
  const double wind = read_wind(table, reading.area);
  read_roughness(bottom, wind, false, ocean.bottom.roughness);
  bottom.finish();
  read_boundary_materials(surface, reading, ocean, true, ocean.surface);
  read_roughness(surface, wind, true, ocean.surface.roughness);
  surface.finish();
  describe_spreading(reader, ocean.spreading);
  return ocean;
}

void OceanTable::describe(Fields& field) const {
  Environment shown = ocean;
  if (varies_with_range(ocean) || field.exhaustive()) describe_spreading(field, shown.spreading);
  describe_density(field, shown);
  if (!water_by_map) describe_sound_speed(field, ocean);
  describe_losses(field, shown);
  describe_boundary(field, true, ocean.surface);
  describe_boundary(field, false, ocean.bottom, depth_by_map);
}

namespace {

/// [environment] with what only a sonar needs.
struct SonarOcean {
  const Scenario& scenario;

  void describe(Fields& field) const {
    const Area* const area = scenario.area.get();
    double wind_speed = scenario.wind_speed;
    if (area == nullptr || !area->wind()) describe_wind(field, wind_speed);
    std::optional<OceanOrigin> origin = scenario.origin;
    field("origin", origin, what_origin);
    TransectTable transect{scenario.transect};
    field("transect", transect, "where the ocean's range axis lies on the map");
    describe_area(field, area != nullptr ? &area->settings() : nullptr);
    if (area != nullptr)
      OceanTable{area->everywhere(), true, area->water().has_value()}.describe(field);
    else
      OceanTable{scenario.environment}.describe(field);
  }
};

}  // namespace

void describe_ocean_on_area(Fields& field, const Area& area, const Transect& transect) {
  TransectTable shown{transect};
  field("transect", shown, "where the ocean's range axis lies on the map");
  describe_area(field, &area.settings());
  const Environment& ocean = area.everywhere();
  Spreading spreading = ocean.spreading;
  if (spreading != Spreading{} && !varies_with_range(ocean)) describe_spreading(field, spreading);
  OceanTable{ocean, true, area.water().has_value()}.describe(field);
}

void describe_environment(Fields& field, const Scenario& scenario) {
  SonarOcean environment{scenario};
  field("environment", environment, "the water and its boundaries");
}

void read_environment(TomlTable table, const std::filesystem::path& folder, double frequency,
                      Scenario& scenario) {
  scenario.transect = read_transect(table);
  scenario.origin = read_origin(table);
  OceanReading reading{.folder = folder, .frequency = frequency, .notes = scenario.notes};
  std::optional<AreaReading> area = read_area(table, reading, scenario.origin);
  if (area) reading.area = &*area;
  scenario.wind_speed = read_wind(table, reading.area);
  scenario.environment = read_ocean(table, reading);
  if (area) {
    scenario.area = area->build(scenario.environment, scenario.transect);
    scenario.environment = along_transect(*scenario.area, scenario.transect);
  }
  table.finish();
}

}  // namespace scenario
}  // namespace asdic::detail
