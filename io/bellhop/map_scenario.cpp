#include "io/bellhop/map_scenario.h"

#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/hdf5/scale.h"
#include "raytrace/area/area.h"

namespace asdic::detail::bellhop {
namespace {

constexpr const char* floor_variable = "depth";
constexpr const char* water_variable = "sound_speed";

/// The grid of depths of an area that a case has, or the level one that it was given.
GridFile floor_of(const MapInput& map) {
  const ScalarMap& floor = map.area->floor();
  GridFile grid{.curvilinear = floor.interpolation() == MapInterpolation::bicubic};
  const auto x = floor.grid().x().places(), y = floor.grid().y().places();
  grid.x.assign(x.begin(), x.end());
  grid.y.assign(y.begin(), y.end());
  for (const double northing : grid.y)
    for (const double easting : grid.x) {
      const Vec2 place = floor.frame().on_map(easting, northing);
      grid.values.push_back(floor.at(place.x(), place.y()).value);
    }
  return grid;
}

std::vector<float> floats(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

void write_axes(Hdf5File& file, const std::string& prefix, const GridFile& grid) {
  write_scale(file, prefix + "y", prefix + "y", grid.y, "to the north", "m",
              {.standard_name = "projection_y_coordinate", .axis = "Y"});
  write_scale(file, prefix + "x", prefix + "x", grid.x, "to the east", "m",
              {.standard_name = "projection_x_coordinate", .axis = "X"});
}

}  // namespace

MapScenario map_scenario(const Input& input, const std::string& maps_file) {
  MapScenario made{.run_case = on_plane(input, 0)};
  if (!input.map) return made;
  const MapInput& map = *input.map;
  if (map.relief)
    throw InputError(
        {.where = input.file,
         .got = "a surface with relief over a map (.ati)",
         .expected = "one depth everywhere, in a scenario; \"asdic bellhop\" runs it"});
  if (map.planes() > 1)
    made.notes.push_back(
        "a scenario has one place of its source and one azimuth of its receivers: "
        "these are the first of " +
        std::to_string(map.planes()) + " (environment.transect)");
  if (made.run_case.dimension == 3 && !map.shines_all_around())
    made.notes.push_back(
        "the fan of azimuths is not in the scenario: its source shines all around");
  if (!map.area) return made;
  const double bearing = radians(90.0 - map.azimuth_deg(0));
  AreaSettings settings{.easting = map.source_x.front(),
                        .northing = map.source_y.front(),
                        .bathymetry = {maps_file, floor_variable},
                        .interpolation = map.area->floor().interpolation()};
  if (map.water) settings.sound_speed = MapFile{maps_file, water_variable};
  made.run_case.on_area = {.area = std::make_shared<const Area>(
                               Area::Maps{.floor = map.area->floor(), .water = map.area->water()},
                               map.area->everywhere(), std::move(settings)),
                           .bearing = bearing};
  made.maps = true;
  return made;
}

void write_maps(OutputFile&& output, const Input& input) {
  const MapInput& map = *input.map;
  const GridFile floor = floor_of(map);
  Hdf5File file = Hdf5File::create(output.part());
  write_filetype(file, "asdic ocean area", "1.0");
  file.set_attribute("", "title", "The ocean of " + input.file);
  write_axes(file, "", floor);
  file.write<float>(floor_variable, floats(floor.values), {floor.y.size(), floor.x.size()});
  describe(file, floor_variable, "depth of the sea floor, positive down", "m", cf::sea_floor);
  file.attach_scales(floor_variable, {"y", "x"});
  if (const auto& water = map.water) {
    write_axes(file, "water_", *water);
    write_scale(file, "water_depth", "water_depth", water->z, "below the surface, positive down",
                "m", cf::depth_axis);
    file.write<float>(water_variable, floats(water->values),
                      {water->z.size(), water->y.size(), water->x.size()});
    describe(file, water_variable, "speed of sound", "m/s", cf::sound_speed);
    file.attach_scales(water_variable, {"water_depth", "water_y", "water_x"});
  }
  file.close();
  output.finish();
}

}  // namespace asdic::detail::bellhop
