#include "io/climatology.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "io/netcdf_grid.h"
#include "io/text/quote.h"
#include "io/text/toml_value.h"

namespace asdic {
namespace {

constexpr double earth_radius = 6.371e6;  // [m]

std::string place(double latitude, double longitude) {
  return to_text(latitude) + " N " + to_text(longitude) + " E";
}

/// Finds a variable or says which file lacks it.
NetcdfGrid require(const std::filesystem::path& path, const std::vector<std::string>& names,
                   const std::string& what) {
  if (!std::filesystem::exists(path))
    throw InputError({.where = path.string(),
                      .got = "no such file",
                      .expected = "a netCDF file of " + what +
                                  " (install Debian's ferret-datasets: scripts/setup.sh "
                                  "--climatology, or name a file of your own)"});
  auto grid = NetcdfGrid::find(path, names);
  if (grid) return std::move(*grid);
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw InputError({.where = path.string(),
                    .got = "no variable of " + what,
                    .expected = "one with the name or standard_name " + list});
}

const std::vector<std::string> temperature_names{
    "sea_water_temperature",           "TEMP",   "temperature", "t_an", "water_temp",
    "sea_water_potential_temperature", "thetao", "votemper"};
const std::vector<std::string> salinity_names{"sea_water_salinity",
                                              "sea_water_practical_salinity",
                                              "SALT",
                                              "salinity",
                                              "s_an",
                                              "so",
                                              "vosaline"};

/// Depth of the sea [m]: below 0 on land, NaN where unknown.
class Bathymetry {
 public:
  explicit Bathymetry(const std::filesystem::path& path) : grid_(open(path)) {
    std::string name = grid_.variable();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    is_depth_ = name.find("depth") != std::string::npos || name == "deptho";
  }
  [[nodiscard]] double depth(double latitude, double longitude) const {
    const double value = grid_.nearest(longitude, latitude);
    return is_depth_ ? value : -value;
  }
  [[nodiscard]] const std::string& variable() const { return grid_.variable(); }

 private:
  static NetcdfGrid open(const std::filesystem::path& path) {
    return require(path,
                   {"ROSE", "elevation", "height_above_reference_ellipsoid", "surface_altitude",
                    "altitude", "topo", "bath", "z", "sea_floor_depth_below_geoid",
                    "sea_floor_depth_below_sea_surface", "sea_floor_depth", "deptho", "depth"},
                   "bathymetry");
  }
  NetcdfGrid grid_;
  bool is_depth_ = false;
};

/// Which time steps stand for a month, and a note if the grid cannot tell.
std::vector<std::size_t> time_steps(const NetcdfGrid& grid, std::optional<int> month,
                                    const std::string& what, std::vector<std::string>& notes) {
  std::vector<std::size_t> steps;
  const std::size_t n = grid.times();
  const bool monthly = n >= 12 && n % 12 == 0;
  if (month && monthly)
    for (auto i = static_cast<std::size_t>(*month - 1); i < n; i += 12) steps.push_back(i);
  else
    for (std::size_t i = 0; i < n; ++i) steps.push_back(i);
  if (month && !monthly)
    notes.push_back(what + (n == 1 ? " has no time axis" : " is not on months") +
                    ": it is the mean of the year, not of month " + std::to_string(*month));
  return steps;
}

/// Mean over time steps of those that are there.
template <class Value>
double mean(const std::vector<std::size_t>& steps, Value&& value) {
  double sum = 0.0;
  int count = 0;
  for (const std::size_t step : steps) {
    const double x = value(step);
    if (std::isnan(x)) continue;
    sum += x;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

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
  const NetcdfGrid temperature = require(path, temperature_names, "temperature");
  const NetcdfGrid salinity = require(path, salinity_names, "salinity");
  if (temperature.depths().empty() || temperature.depths() != salinity.depths())
    throw InputError({.where = path.string(),
                      .got = "temperature and salinity on different depths, or none",
                      .expected = "both on one depth axis"});
  const double x = ocean.longitude, y = ocean.latitude;
  const auto steps = time_steps(temperature, ocean.month, "the profile", ocean.notes);
  std::string unit = temperature.units();
  const double zero = unit == "K" || unit == "kelvin" || unit == "Kelvin" ? 273.15 : 0.0;
  for (std::size_t level = 0; level < temperature.depths().size(); ++level) {
    const double t =
        mean(steps, [&](std::size_t step) { return temperature.nearest(x, y, level, step); });
    const double s =
        mean(steps, [&](std::size_t step) { return salinity.nearest(x, y, level, step); });
    if (std::isnan(t) || std::isnan(s)) break;
    ocean.depth.push_back(temperature.depths()[level]);
    ocean.temperature.push_back(t - zero);
    ocean.salinity.push_back(s);
  }
  if (ocean.depth.empty())
    throw InputError({.where = path.string() + ": " + place(y, x),
                      .got = "no temperature and salinity",
                      .expected = "a place at sea, within the grid"});
  if (ocean.depth.back() < ocean.water_depth)
    ocean.notes.push_back("the profile ends at " + to_text(ocean.depth.back()) +
                          " m; below, its last temperature and salinity go on to the bottom at " +
                          to_text(std::round(ocean.water_depth)) + " m");
  ocean.origins.push_back("profile: " + path.filename().string() + ", " + temperature.variable() +
                          " and " + salinity.variable());
}

void check_place(double latitude, double longitude) {
  if (!(std::abs(latitude) <= 90.0))
    throw InputError({.where = "latitude",
                      .got = to_text(latitude),
                      .expected = "a latitude from -90 to 90 degrees north"});
  if (!(std::abs(longitude) <= 360.0))
    throw InputError({.where = "longitude",
                      .got = to_text(longitude),
                      .expected = "a longitude from -180 to 360 degrees east"});
}

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

OceanSection sample_transect(const OceanSources& sources, double latitude, double longitude,
                             double bearing_deg, double range) {
  check_place(latitude, longitude);
  if (!(range > 0.0 && range <= pi * earth_radius))
    throw InputError({.where = "range",
                      .got = to_text(range) + " m",
                      .expected = "a range above 0 and at most half way round the Earth"});
  const Bathymetry bathymetry(sources.bathymetry);
  OceanSection transect{.bearing_deg = bearing_deg};
  const int steps = std::max(1, static_cast<int>(std::ceil(range / 5000.0)));
  const double phi = radians(latitude), theta = radians(bearing_deg);
  for (int i = 0; i <= steps; ++i) {
    const double r = range * i / steps;
    const double delta = r / earth_radius;
    // The direct problem on a sphere: sin φ₂ = sin φ cos δ + cos φ sin δ cos θ.
    const double sine =
        std::sin(phi) * std::cos(delta) + std::cos(phi) * std::sin(delta) * std::cos(theta);
    const double turn = std::atan2(std::sin(theta) * std::sin(delta) * std::cos(phi),
                                   std::cos(delta) - std::sin(phi) * sine);
    const double depth = bathymetry.depth(degrees(std::asin(std::clamp(sine, -1.0, 1.0))),
                                          longitude + degrees(turn));
    if (!(depth > 0.0)) {
      if (i == 0)
        throw InputError({.where = sources.bathymetry.string() + ": " + place(latitude, longitude),
                          .got = "no sea",
                          .expected = "a transect that starts at sea"});
      transect.notes.push_back("the transect ends at the coast, before " + to_text(r) + " m");
      break;
    }
    transect.range.push_back(r);
    transect.depth.push_back(depth);
  }
  return transect;
}

std::string write_scenario_fragment(const OceanSample& ocean,
                                    const std::optional<OceanSection>& transect) {
  std::string text = "# The ocean at " + place(ocean.latitude, ocean.longitude) + ", " +
                     (ocean.month ? "month " + std::to_string(*ocean.month) : "mean of the year") +
                     ". Written by asdic ocean.\n";
  for (const std::string& origin : ocean.origins) text += "# " + origin + "\n";
  for (const std::string& note : ocean.notes) text += "# Note: " + note + ".\n";
  text += "\n[environment]\n";
  if (ocean.wind_speed) text += "wind_speed = " + fixed(*ocean.wind_speed, 1) + "  # [m/s]\n";
  text += "\n[environment.sound_speed]\nkind = \"temperature-salinity\"\n";
  text += "equation = \"chen-millero\"\nlatitude_deg = " + to_text(ocean.latitude) + "\n";
  text += "interpolation = \"pchip\"\n";
  const bool whole = std::all_of(ocean.depth.begin(), ocean.depth.end(),
                                 [](double z) { return z == std::round(z); });
  text += "depth = " + array(ocean.depth, whole ? 0 : 1) + "  # [m]\n";
  text += "temperature = " + array(ocean.temperature, 3) + "  # [degC]\n";
  text += "salinity = " + array(ocean.salinity, 3) + "  # [psu]\n";
  text += "\n[environment.bottom]\ndepth = " + fixed(ocean.water_depth, 0) + "  # [m]\n";
  text += "kind = \"fluid\"  # the data say nothing of the sediment: this is abyssal clay\n";
  text += "speed = 1520.0\ndensity = 1400.0\nattenuation_db_per_wavelength = 0.1\n";
  if (transect) {
    text += "\n# Bearing " + to_text(transect->bearing_deg) +
            " degrees. The solver's bottom is flat: only the depth above is used.\n";
    for (const std::string& note : transect->notes) text += "# Note: " + note + ".\n";
    text += "[environment.bottom.transect]\nrange = " + array(transect->range, 0) + "  # [m]\n";
    text += "depth = " + array(transect->depth, 0) + "  # [m]\n";
  }
  return text;
}

}  // namespace asdic
