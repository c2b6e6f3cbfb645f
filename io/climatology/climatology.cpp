#include "io/climatology/climatology.h"

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/text.h"
#include "io/climatology/grids.h"

namespace asdic::detail {
namespace {

using namespace climatology;

void read_wind(const std::filesystem::path& path, OceanSample& ocean) {
  if (path.empty()) {
    ocean.notes.push_back("no file of winds was named");
    return;
  }
  const double x = ocean.longitude, y = ocean.latitude;
  double speed = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::string> names{"wind_speed", "WSPD", "windspeed"};
  if (std::filesystem::exists(path) && !NetcdfGrid::find(path, names)) {
    const NetcdfGrid east = require(path, {"eastward_wind", "UWND", "u10", "uas"}, "wind");
    const NetcdfGrid north = require(path, {"northward_wind", "VWND", "v10", "vas"}, "wind");
    const auto steps = time_steps(east, ocean.month, "the wind", ocean.notes);
    speed = mean(steps, [&](std::size_t t) {
      return std::hypot(east.bilinear(x, y, 0, t), north.bilinear(x, y, 0, t));
    });
    ocean.origins.push_back("wind: " + path.filename().string() + ", " + east.variable() + " and " +
                            north.variable());
    ocean.notes.push_back("the wind speed is that of mean components, less than the mean speed");
  } else {
    const NetcdfGrid grid = require(path, names, "wind");
    const auto steps = time_steps(grid, ocean.month, "the wind", ocean.notes);
    speed = mean(steps, [&](std::size_t t) { return grid.bilinear(x, y, 0, t); });
    ocean.origins.push_back("wind: " + path.filename().string() + ", " + grid.variable());
  }
  if (std::isnan(speed))
    ocean.notes.push_back("the wind is not known there");
  else
    ocean.wind_speed = speed;
}

void read_profile(const std::filesystem::path& path, OceanSample& ocean) {
  const Hydrography hydrography(path, ocean.month, ocean.notes);
  const Column column = hydrography.at(ocean.latitude, ocean.longitude);
  ocean.depth = column.depth;
  ocean.temperature = column.temperature;
  ocean.salinity = column.salinity;
  if (ocean.depth.empty())
    throw InputError({.where = path.string() + ": " + place(ocean.latitude, ocean.longitude),
                      .got = "no temperature and salinity",
                      .expected = "a place at sea, within the grid"});
  if (ocean.depth.back() < ocean.water_depth)
    ocean.notes.push_back("the profile ends at " + to_text(ocean.depth.back()) +
                          " m; below, its last temperature and salinity go on to the bottom at " +
                          to_text(std::round(ocean.water_depth)) + " m");
  ocean.origins.push_back("profile: " + path.filename().string() + ", " + hydrography.variables());
}

}  // namespace

OceanSources default_ocean_sources(const std::filesystem::path& directory) {
  return {.hydrography = directory / "levitus_climatology.cdf",
          .bathymetry = directory / "etopo5.cdf",
          .wind = directory / "coads_climatology.cdf"};
}

OceanSample sample_ocean(const OceanSources& sources, double latitude, double longitude,
                         std::optional<int> month) {
  check_place(latitude, longitude);
  if (month && (*month < 1 || *month > 12))
    throw InputError(
        {.where = "month", .got = std::to_string(*month), .expected = "a month from 1 to 12"});
  OceanSample ocean{.latitude = latitude, .longitude = longitude, .month = month};
  const Bathymetry bathymetry(sources.bathymetry);
  ocean.water_depth = bathymetry.depth(latitude, longitude);
  if (!(ocean.water_depth > 0.0))
    throw InputError({.where = sources.bathymetry.string() + ": " + place(latitude, longitude),
                      .got = std::isnan(ocean.water_depth)
                                 ? "no depth"
                                 : "land, " + to_text(std::round(-ocean.water_depth)) + " m high",
                      .expected = "a place at sea, within the grid"});
  read_profile(sources.hydrography, ocean);
  ocean.origins.push_back("depth: " + sources.bathymetry.filename().string() + ", " +
                          bathymetry.variable());
  read_wind(sources.wind, ocean);
  return ocean;
}

}  // namespace asdic::detail
