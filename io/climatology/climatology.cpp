#include "io/climatology/climatology.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/climatology/grids.h"
#include "raytrace/ocean/seawater.h"
#include "raytrace/ocean/sound_speed.h"

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

// Water and sea floor along a great circle.

namespace {

using namespace climatology;

/// Speed of sound at depths [m], in the way of scenarios of temperature and salinity: PCHIP between
/// measured levels, the last one's water going on below.
std::vector<double> speeds_of(const Column& column, const std::vector<double>& depths,
                              double latitude) {
  std::vector<double> z, c;
  const auto add = [&](double depth, std::size_t level) {
    z.push_back(depth);
    c.push_back(sound_speed(SeawaterEquation::chen_millero, column.temperature[level],
                            column.salinity[level], depth, latitude));
  };
  if (column.depth.front() > 0.0) add(0.0, 0);
  for (std::size_t level = 0; level < column.depth.size(); ++level) add(column.depth[level], level);
  while (z.back() < depths.back()) add(z.back() + 250.0, column.depth.size() - 1);
  const auto profile = SoundSpeedProfile::table(z, c, Interpolation::pchip);
  std::vector<double> speed;
  speed.reserve(depths.size());
  for (const double depth : depths) speed.push_back(profile.at(depth).c);
  return speed;
}

/// Levels for straight lines: the measured ones, where the curve's bend changes, and between them
/// some 5 m apart near the surface, a thirtieth of the depth further down. A curve leaves its chord
/// by h²c″/8: 0.02 m/s in a thermocline of 5e-3 m/s per m², 0.035 m/s where PCHIP bends most about
/// the axis of the sound channel.
std::vector<double> levels_down_to(double deepest, const std::vector<double>& measured) {
  std::vector<double> levels = {0.0};
  const auto go_to = [&](double end) {
    const double begin = levels.back(), width = end - begin;
    const int pieces = static_cast<int>(std::ceil(width / std::max(5.0, begin / 30.0)));
    for (int i = 1; i <= pieces; ++i) levels.push_back(std::round(begin + width * i / pieces));
  };
  deepest = std::ceil(deepest);
  for (const double depth : measured)
    if (depth >= levels.back() + 1.0 && depth <= deepest - 1.0) go_to(depth);
  go_to(deepest);
  return levels;
}

/// A place on the sphere at a distance [m] along a great circle: the direct problem,
/// sin φ₂ = sin φ cos δ + cos φ sin δ cos θ.
struct Place {
  double latitude, longitude;  // [°]

  [[nodiscard]] Place at(double distance, double bearing_deg) const {
    const double phi = radians(latitude), theta = radians(bearing_deg);
    const double delta = distance / earth_radius;
    const double sine =
        std::sin(phi) * std::cos(delta) + std::cos(phi) * std::sin(delta) * std::cos(theta);
    const double turn = std::atan2(std::sin(theta) * std::sin(delta) * std::cos(phi),
                                   std::cos(delta) - std::sin(phi) * sine);
    return {degrees(std::asin(std::clamp(sine, -1.0, 1.0))), longitude + degrees(turn)};
  }
};

/// Profiles in the middle of the spans that they are nearest to.
void read_stations(const Hydrography& hydrography, const Place& start, OceanSection& section) {
  struct Segment {
    Column column;
    double first, last, latitude;
  };
  std::vector<Segment> segments;
  for (const double r : section.range) {
    const Place here = start.at(r, section.bearing_deg);
    Column column = hydrography.at(here.latitude, here.longitude);
    if (column.depth.empty()) continue;  // land in the grid: the neighbours' water goes on
    if (!segments.empty() && column == segments.back().column)
      segments.back().last = r;
    else
      segments.push_back({std::move(column), r, r, here.latitude});
  }
  const double deepest = *std::max_element(section.floor.begin(), section.floor.end());
  section.depth = levels_down_to(deepest, hydrography.levels());
  for (const Segment& segment : segments) {
    section.station.push_back(0.5 * (segment.first + segment.last));
    const auto speed = speeds_of(segment.column, section.depth, segment.latitude);
    section.speed.insert(section.speed.end(), speed.begin(), speed.end());
  }
}

}  // namespace

OceanSection sample_section(const OceanSources& sources, double latitude, double longitude,
                            double bearing_deg, double range, std::optional<int> month) {
  check_place(latitude, longitude);
  if (!(range > 0.0 && range <= pi * earth_radius))
    throw InputError({.where = "range",
                      .got = to_text(range) + " m",
                      .expected = "a range above 0 and at most half way round the Earth"});
  const Bathymetry bathymetry(sources.bathymetry);
  OceanSection section{.bearing_deg = bearing_deg};
  const Place start{latitude, longitude};
  const int steps = std::max(1, static_cast<int>(std::ceil(range / 5000.0)));
  for (int i = 0; i <= steps; ++i) {
    const double r = range * i / steps;
    const Place here = start.at(r, bearing_deg);
    const double depth = bathymetry.between(here.latitude, here.longitude);
    if (!(depth > 0.0)) {
      if (i == 0)
        throw InputError({.where = sources.bathymetry.string() + ": " + place(latitude, longitude),
                          .got = "no sea",
                          .expected = "a transect that starts at sea"});
      section.notes.push_back("the transect ends at the coast, before " + to_text(r) + " m");
      break;
    }
    section.range.push_back(r);
    section.floor.push_back(depth);
  }
  std::vector<std::string> told_with_the_profile;
  read_stations(Hydrography(sources.hydrography, month, told_with_the_profile), start, section);
  return section;
}

namespace {

std::string fixed(double value, int digits) {
  char text[64] = {};
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string array(const std::vector<double>& values, int digits) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += i == 0 ? "" : i % 10 == 0 ? ",\n  " : ", ";
    text += fixed(values[i], digits);
  }
  return text + "]";
}

std::string profile_table(const OceanSample& ocean) {
  std::string text = "kind = \"temperature-salinity\"\n";
  text += "equation = \"chen-millero\"\nlatitude_deg = " + to_text(ocean.latitude) + "\n";
  text += "interpolation = \"pchip\"\n";
  const bool whole = std::all_of(ocean.depth.begin(), ocean.depth.end(),
                                 [](double z) { return z == std::round(z); });
  text += "depth = " + array(ocean.depth, whole ? 0 : 1) + "  # [m]\n";
  text += "temperature = " + array(ocean.temperature, 3) + "  # [degC]\n";
  text += "salinity = " + array(ocean.salinity, 3) + "  # [psu]\n";
  return text;
}

std::string section_table(const OceanSection& section) {
  std::string text = "kind = \"section\"\nrange = " + array(section.station, 0) + "  # [m]\n";
  text += "depth = " + array(section.depth, 0) + "  # [m]\n";
  text += "speed = [  # [m/s], a row for every range\n";
  const std::size_t n = section.depth.size();
  for (std::size_t i = 0; i < section.station.size(); ++i) {
    const auto row = section.speed.begin() + static_cast<std::ptrdiff_t>(i * n);
    text += array({row, row + static_cast<std::ptrdiff_t>(n)}, 2) + ",\n";
  }
  return text + "]\n";
}

}  // namespace

std::string write_scenario_fragment(const OceanSample& ocean,
                                    const std::optional<OceanSection>& section) {
  std::string text = "# The ocean at " + to_text(ocean.latitude) + " N " +
                     to_text(ocean.longitude) + " E" + ", " +
                     (ocean.month ? "month " + std::to_string(*ocean.month) : "mean of the year") +
                     ". Written by asdic ocean.\n";
  for (const std::string& origin : ocean.origins) text += "# " + origin + "\n";
  for (const std::string& note : ocean.notes) text += "# Note: " + note + ".\n";
  if (section)
    for (const std::string& note : section->notes) text += "# Note: " + note + ".\n";
  text += "\n[environment]\n";
  if (ocean.wind_speed) text += "wind_speed = " + fixed(*ocean.wind_speed, 1) + "  # [m/s]\n";
  if (section)
    text +=
        "\n[environment.transect]  # where range 0 is on the map, and where ranges grow\n"
        "origin = [0.0, 0.0]\nbearing_deg = " +
        to_text(section->bearing_deg) + "\n";
  const bool fronts = section && section->station.size() > 1;
  text += "\n[environment.sound_speed]\n";
  text += fronts ? section_table(*section) : profile_table(ocean);
  text += "\n[environment.bottom]\n";
  if (!section) text += "depth = " + fixed(ocean.water_depth, 0) + "  # [m]\n";
  text += "kind = \"fluid\"  # the data say nothing of the sediment: this is abyssal clay\n";
  text += "speed = 1520.0\ndensity = 1400.0\nattenuation_db_per_wavelength = 0.1\n";
  if (section) {
    text += "\n[environment.bottom.shape]\ninterpolation = \"smooth\"\n";
    text += "range = " + array(section->range, 0) + "  # [m]\n";
    text += "depth = " + array(section->floor, 0) + "  # [m]\n";
  }
  return text;
}

}  // namespace asdic::detail
