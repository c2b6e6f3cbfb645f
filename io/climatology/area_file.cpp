// Part of climatology.h: the ocean of an area in one netCDF-4 file (docs/formats/ocean-area.md).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/climatology/climatology.h"
#include "io/climatology/floor.h"
#include "io/climatology/water.h"
#include "io/climatology/wind.h"
#include "io/hdf5/scale.h"

namespace asdic::detail {
namespace {

using climatology::Floor;
using climatology::Place;
using climatology::Tiles;
using climatology::Water;
using climatology::WaterColumn;
using climatology::Wind;

/// A box of degrees.
struct Box {
  double south, north, west, east;
};

Box box_about(const OceanRequest& request, double side) {
  constexpr double least_radius = 6.335e6;  // of the Earth's curvature: the box is no smaller [m]
  const double half = degrees(0.5 * side / least_radius);
  const double furthest = std::abs(request.latitude) + half;
  if (!(side > 0.0 && furthest < 89.0 && half < 45.0))
    throw InputError({.where = "area",
                      .got = to_text(side) + " m about " +
                             climatology::place(request.latitude, request.longitude),
                      .expected = "a side above 0 that stays away from the poles"});
  // Meridians draw near one another towards the pole: the box is as wide where they are nearest.
  const double across = half / std::cos(radians(furthest));
  return {request.latitude - half, request.latitude + half, request.longitude - across,
          request.longitude + across};
}

/// Axes of a variable's own.
struct MapAxes {
  std::string latitude, longitude;
};

void write_axes(Hdf5File& file, const MapAxes& axes, const DataGrid::Block& grid) {
  write_scale(file, axes.latitude, axes.latitude, grid.northings, "of the cells' middles",
              "degrees_north", {.standard_name = "latitude", .axis = "Y"});
  write_scale(file, axes.longitude, axes.longitude, grid.eastings, "of the cells' middles",
              "degrees_east", {.standard_name = "longitude", .axis = "X"});
}

template <class T>
void write_map(Hdf5File& file, const std::string& name, const std::vector<T>& values,
               const DataGrid::Block& grid, const MapAxes& axes, const std::string& long_name,
               const std::string& units, const Meaning& meaning) {
  file.write<T>(name, values, {grid.northings.size(), grid.eastings.size()});
  describe(file, name, long_name, units, meaning);
  file.attach_scales(name, {axes.latitude, axes.longitude});
}

std::vector<float> floats(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

/// What the files do not reach of a box.
void tell_reach(const DataGrid::Block& grid, const Box& box, const Tiles& tiles, const char* what,
                const OceanRequest& request, std::vector<std::string>& notes) {
  if (grid.eastings.size() < 2 || grid.northings.size() < 2)
    throw InputError({.where = tiles.name_at(request.latitude, request.longitude),
                      .got = std::to_string(grid.northings.size()) + " by " +
                             std::to_string(grid.eastings.size()) + " points of its grid",
                      .expected = "at least 2 by 2: a larger --area, or a finer grid"});
  const double dx = grid.eastings[1] - grid.eastings[0], dy = grid.northings[1] - grid.northings[0];
  std::string sides;
  const auto add = [&](bool ends, const char* side) {
    if (ends) sides += (sides.empty() ? "" : ", ") + std::string(side);
  };
  add(grid.northings.front() > box.south + dy, "south");
  add(grid.northings.back() < box.north - dy, "north");
  add(grid.eastings.front() > box.west + dx, "west");
  add(grid.eastings.back() < box.east - dx, "east");
  if (!sides.empty())
    notes.push_back(std::string("the files of ") + what + " end within the area, in the " + sides +
                    ": it is smaller there");
}

/// Columns without water take that of the nearest with some: nothing is heard there, but values are
/// interpolated between.
std::size_t fill_columns(std::vector<WaterColumn>& columns, std::size_t width) {
  std::vector<std::size_t> wet;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (!columns[i].depth.empty()) wet.push_back(i);
  std::size_t filled = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!columns[i].depth.empty() || wet.empty()) continue;
    const auto away = [&](std::size_t k) {
      const auto dx = static_cast<double>(k % width) - static_cast<double>(i % width),
                 dy = static_cast<double>(k / width) - static_cast<double>(i / width);
      return dx * dx + dy * dy;
    };
    const auto nearest = *std::min_element(
        wet.begin(), wet.end(), [&](std::size_t a, std::size_t b) { return away(a) < away(b); });
    columns[i] = columns[nearest];
    ++filled;
  }
  return filled;
}

/// Measured levels of all columns, from the surface down past the deepest place.
std::vector<double> levels_of(const std::vector<WaterColumn>& columns, double deepest) {
  std::set<double> all = {0.0};
  for (const WaterColumn& column : columns)
    for (const double z : column.depth)
      if (z > 0.0) all.insert(z);
  std::vector<double> levels;
  for (const double z : all) {
    levels.push_back(z);
    if (z >= deepest) break;
  }
  while (levels.back() < deepest || levels.size() < 2) levels.push_back(levels.back() + 250.0);
  return levels;
}

void write_water(Hdf5File& file, const Water& water, const OceanRequest& request, const Box& box,
                 double deepest, OceanArea& area) {
  if (water.is_everywhere_the_same()) {
    area.notes.push_back("one profile is the water of the whole area");
    return;
  }
  const Tiles& tiles = water.speed() != nullptr ? *water.speed() : *water.temperature();
  const auto grid = tiles.crop(box.south, box.north, box.west, box.east, false);
  tell_reach(grid, box, tiles, "the water", request, area.notes);
  std::vector<WaterColumn> columns;
  for (const double latitude : grid.northings)
    for (const double longitude : grid.eastings) columns.push_back(water.at(latitude, longitude));
  const std::size_t width = grid.eastings.size();
  if (const std::size_t filled = fill_columns(columns, width); filled == columns.size())
    static_cast<void>(water.require(request.latitude, request.longitude));
  else if (filled > 0)
    area.notes.push_back(std::to_string(filled) + " of " + std::to_string(columns.size()) +
                         " columns are land in the grid of the water: they have the nearest "
                         "column's");
  const std::vector<double> levels = levels_of(columns, deepest);
  double shallowest = deepest;
  for (const WaterColumn& column : columns) shallowest = std::min(shallowest, column.depth.back());
  if (shallowest < deepest)
    area.notes.push_back("profiles of the area end at " + to_text(std::round(shallowest)) +
                         " m or deeper; below, their last water goes on to the floor at " +
                         to_text(std::round(deepest)) + " m");
  if (double(levels.size()) * double(columns.size()) > 2e8)
    throw InputError({.where = "area",
                      .got = std::to_string(columns.size()) + " columns of " +
                             std::to_string(levels.size()) + " levels",
                      .expected = "at most 2e8 speeds: a smaller --area"});
  std::vector<float> speed(levels.size() * columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto c = climatology::speeds_of(columns[i], levels, grid.northings[i / width]);
    for (std::size_t level = 0; level < levels.size(); ++level)
      speed[level * columns.size() + i] = static_cast<float>(c[level]);
  }
  const MapAxes axes{"water_latitude", "water_longitude"};
  write_axes(file, axes, grid);
  write_scale(file, "water_depth", "water_depth", levels, "below the surface, positive down", "m",
              cf::depth_axis);
  file.write<float>("sound_speed", speed, {levels.size(), grid.northings.size(), width});
  describe(file, "sound_speed",
           "speed of sound; below the last measured level its water goes on to the floor", "m/s",
           cf::sound_speed);
  file.attach_scales("sound_speed", {"water_depth", axes.latitude, axes.longitude});
  area.sound_speed = true;
}

void write_sediment(Hdf5File& file, const OceanSources& sources, const OceanRequest& request,
                    const Box& box, const Floor& floor, const DataGrid::Block& bathymetry,
                    const MapAxes& floor_axes, OceanArea& area) {
  std::set<int> numbers;
  std::vector<std::int8_t> classes;
  if (sources.sediment.empty()) {
    for (const double value : bathymetry.values) {
      const double depth = std::isnan(value) ? 0.0 : floor.sign() * value;
      classes.push_back(static_cast<std::int8_t>(sediment_at_depth(depth).number));
    }
    write_map(file, "sediment", classes, bathymetry, floor_axes, "kind of sea floor, by the depth",
              "", {});
  } else {
    const SedimentMap map(sources.sediment, request.when);
    const auto grid = map.tiles().crop(box.south, box.north, box.west, box.east);
    tell_reach(grid, box, map.tiles(), "sediments", request, area.notes);
    std::size_t by_depth = 0;
    for (std::size_t j = 0; j < grid.northings.size(); ++j)
      for (std::size_t i = 0; i < grid.eastings.size(); ++i) {
        const double value = grid.at(i, j);
        const Place place{grid.northings[j], grid.eastings[i]};
        if (!std::isnan(value)) {
          classes.push_back(static_cast<std::int8_t>(
              map.of_value(value, map.tiles().name_at(place.latitude, place.longitude)).number));
          continue;
        }
        const double depth = floor.between(place);
        classes.push_back(
            static_cast<std::int8_t>(sediment_at_depth(std::isnan(depth) ? 0.0 : depth).number));
        ++by_depth;
      }
    if (by_depth > 0)
      area.notes.push_back(std::to_string(by_depth) + " of " + std::to_string(classes.size()) +
                           " cells have no sediment on the map: it was taken by the depth");
    const MapAxes axes{"sediment_latitude", "sediment_longitude"};
    write_axes(file, axes, grid);
    write_map(file, "sediment", classes, grid, axes, "kind of sea floor", "", {});
  }
  for (const std::int8_t number : classes) numbers.insert(number);
  std::vector<std::string> names;
  for (const Sediment& sediment : sediments())
    if (numbers.count(sediment.number) != 0) {
      area.classes.push_back(sediment);
      names.push_back(std::to_string(sediment.number) + " " + sediment.name);
    }
  file.set_attribute("sediment", "classes", names);
}

void write_wind(Hdf5File& file, const OceanSources& sources, const OceanRequest& request,
                const Box& box, OceanArea& area) {
  if (sources.wind.empty()) return;
  const Wind wind(sources.wind, request.when);
  const auto grid = wind.first().crop(box.south, box.north, box.west, box.east, false);
  tell_reach(grid, box, wind.first(), "the wind", request, area.notes);
  std::vector<float> speeds;
  double sum = 0.0;
  std::size_t known = 0;
  for (const double latitude : grid.northings)
    for (const double longitude : grid.eastings) {
      const double speed = wind.at(latitude, longitude);
      speeds.push_back(static_cast<float>(speed));
      if (!std::isnan(speed)) sum += speed, ++known;
    }
  if (known == 0) {
    area.notes.push_back("the wind is not known in the area");
    return;
  }
  if (known < speeds.size()) {
    const auto mean = static_cast<float>(sum / static_cast<double>(known));
    for (float& speed : speeds)
      if (std::isnan(speed)) speed = mean;
    area.notes.push_back(std::to_string(speeds.size() - known) + " of " +
                         std::to_string(speeds.size()) +
                         " points of the wind have none: they have the mean of the others");
  }
  const MapAxes axes{"wind_latitude", "wind_longitude"};
  write_axes(file, axes, grid);
  write_map(file, "wind_speed", speeds, grid, axes, "at 10 m height", "m/s",
            {.standard_name = "wind_speed"});
  area.wind = true;
}

}  // namespace

OceanArea write_ocean_area(const OceanSources& sources, const OceanRequest& request,
                           OceanSample& centre, double side, OutputFile&& output) {
  OceanArea area{.side = side, .file = output.target()};
  const Box box = box_about(request, side);
  const Floor floor(sources.bathymetry, {});
  const auto bathymetry = floor.tiles().crop(box.south, box.north, box.west, box.east);
  tell_reach(bathymetry, box, floor.tiles(), "bathymetry", request, area.notes);
  double deepest = centre.water_depth;
  std::size_t holes = 0;
  std::set<int> at_sea;    // kinds of sea floor, by the depth
  std::string first_hole;  // "file.nc: variable, … at 33.7 N -62.5 E"
  const auto rounded = [](double degree) { return std::round(1e4 * degree) / 1e4; };
  std::vector<double> elevation;
  for (std::size_t k = 0; k < bathymetry.values.size(); ++k) {
    const double value = bathymetry.values[k];
    const Place here{bathymetry.northings[k / bathymetry.eastings.size()],
                     bathymetry.eastings[k % bathymetry.eastings.size()]};
    elevation.push_back(-floor.checked(floor.sign() * value, here));
    if (std::isnan(value) && ++holes == 1)
      first_hole = floor.tiles().short_name_at(here.latitude, here.longitude) + ", the first at " +
                   climatology::place(rounded(here.latitude), rounded(here.longitude));
    if (-elevation.back() > 0.0) at_sea.insert(sediment_at_depth(-elevation.back()).number);
    if (!std::isnan(value)) deepest = std::max(deepest, -elevation.back());
  }
  if (holes > 0)
    area.notes.push_back(std::to_string(holes) + " of " + std::to_string(elevation.size()) +
                         " cells of the bathymetry are holes in " + first_hole +
                         "; a second --bathymetry on the same grid fills them");
  Hdf5File file = Hdf5File::create(output.part());
  write_filetype(file, "asdic ocean area", "1.0");
  file.set_attribute("", "title",
                     "The ocean about " + climatology::place(request.latitude, request.longitude));
  file.set_attribute("", "latitude_deg", request.latitude);
  file.set_attribute("", "longitude_deg", request.longitude);
  file.set_attribute("", "side_m", side);
  file.set_attribute("", "time", request.when.text());
  file.set_attribute("", "ocean_sources", centre.origin().source_lines());
  const MapAxes axes{"latitude", "longitude"};
  write_axes(file, axes, bathymetry);
  write_map(file, "elevation", floats(elevation), bathymetry, axes,
            "height of the sea floor above the mean sea surface, positive up", "m",
            {.standard_name = "height_above_mean_sea_level"});
  write_water(file, Water(sources, request.when, request.latitude, request.longitude), request, box,
              deepest, area);
  write_sediment(file, sources, request, box, floor, bathymetry, axes, area);
  if (sources.sediment.empty() && at_sea.size() > 1) {
    std::string kinds;
    for (const Sediment& one : area.classes)
      if (at_sea.count(one.number) != 0) kinds += (kinds.empty() ? "" : ", ") + one.name;
    std::erase_if(centre.notes,
                  [&](const std::string& note) { return note.starts_with(centre.sediment_by); });
    area.notes.push_back("the data say nothing of the sediment: by the depth of each cell, " +
                         kinds + " were taken; --sediment takes a map");
  }
  write_wind(file, sources, request, box, area);
  if (!area.notes.empty()) file.set_attribute("", "notes", area.notes);
  file.close();
  output.finish();
  return area;
}

}  // namespace asdic::detail
