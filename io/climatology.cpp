#include "io/climatology.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "io/netcdf_grid.h"
#include "io/text/quote.h"
#include "io/text/toml_value.h"
#include "raytrace/ocean/seawater.h"
#include "raytrace/ocean/sound_speed.h"

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
  /// Between grid points, for a floor without steps.
  [[nodiscard]] double between(double latitude, double longitude) const {
    const double value = grid_.bilinear(longitude, latitude);
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

/// Temperature and salinity of one water column.
struct Column {
  std::vector<double> depth, temperature, salinity;  // [levels] [m], [°C], [psu]

  bool operator==(const Column&) const = default;
};

class Hydrography {
 public:
  Hydrography(const std::filesystem::path& path, std::optional<int> month,
              std::vector<std::string>& notes)
      : temperature_(require(path, temperature_names, "temperature")),
        salinity_(require(path, salinity_names, "salinity")) {
    if (temperature_.depths().empty() || temperature_.depths() != salinity_.depths())
      throw InputError({.where = path.string(),
                        .got = "temperature and salinity on different depths, or none",
                        .expected = "both on one depth axis"});
    steps_ = time_steps(temperature_, month, "the profile", notes);
    const std::string unit = temperature_.units();
    zero_ = unit == "K" || unit == "kelvin" || unit == "Kelvin" ? 273.15 : 0.0;
  }

  /// Of the nearest grid point, down to the first level that is missing.
  [[nodiscard]] Column at(double latitude, double longitude) const {
    Column column;
    for (std::size_t level = 0; level < temperature_.depths().size(); ++level) {
      const auto mean_of = [&](const NetcdfGrid& grid) {
        return mean(steps_, [&](std::size_t step) {
          return grid.nearest(longitude, latitude, level, step);
        });
      };
      const double t = mean_of(temperature_), s = mean_of(salinity_);
      if (std::isnan(t) || std::isnan(s)) break;
      column.depth.push_back(temperature_.depths()[level]);
      column.temperature.push_back(t - zero_);
      column.salinity.push_back(s);
    }
    return column;
  }
  [[nodiscard]] const std::vector<double>& levels() const { return temperature_.depths(); }
  [[nodiscard]] std::string variables() const {
    return temperature_.variable() + " and " + salinity_.variable();
  }

 private:
  NetcdfGrid temperature_, salinity_;
  std::vector<std::size_t> steps_;
  double zero_ = 0.0;
};

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
    const double pieces = std::ceil(width / std::max(5.0, begin / 30.0));
    for (double i = 1.0; i <= pieces; ++i) levels.push_back(std::round(begin + width * i / pieces));
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

/// Profiles in the middle of the stretches that they are nearest to.
void read_stations(const Hydrography& hydrography, const Place& start, OceanSection& section) {
  struct Stretch {
    Column column;
    double first, last, latitude;
  };
  std::vector<Stretch> stretches;
  for (const double r : section.range) {
    const Place here = start.at(r, section.bearing_deg);
    Column column = hydrography.at(here.latitude, here.longitude);
    if (column.depth.empty()) continue;  // land in the grid: the neighbours' water goes on
    if (!stretches.empty() && column == stretches.back().column)
      stretches.back().last = r;
    else
      stretches.push_back({std::move(column), r, r, here.latitude});
  }
  const double deepest = *std::max_element(section.floor.begin(), section.floor.end());
  section.depth = levels_down_to(deepest, hydrography.levels());
  for (const Stretch& stretch : stretches) {
    section.station.push_back(0.5 * (stretch.first + stretch.last));
    const auto speed = speeds_of(stretch.column, section.depth, stretch.latitude);
    section.speed.insert(section.speed.end(), speed.begin(), speed.end());
  }
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

}  // namespace asdic
