#include "io/climatology/grids.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::climatology {
namespace {

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

NetcdfGrid open_bathymetry(const std::filesystem::path& path) {
  return require(path,
                 {"ROSE", "elevation", "height_above_reference_ellipsoid", "surface_altitude",
                  "altitude", "topo", "bath", "z", "sea_floor_depth_below_geoid",
                  "sea_floor_depth_below_sea_surface", "sea_floor_depth", "deptho", "depth"},
                 "bathymetry");
}

}  // namespace

std::string place(double latitude, double longitude) {
  return to_text(latitude) + " N " + to_text(longitude) + " E";
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

Bathymetry::Bathymetry(const std::filesystem::path& path) : grid_(open_bathymetry(path)) {
  std::string name = grid_.variable();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  is_depth_ = name.find("depth") != std::string::npos || name == "deptho";
}

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

Hydrography::Hydrography(const std::filesystem::path& path, std::optional<int> month,
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

Column Hydrography::at(double latitude, double longitude) const {
  Column column;
  for (std::size_t level = 0; level < temperature_.depths().size(); ++level) {
    const auto mean_of = [&](const NetcdfGrid& grid) {
      return mean(steps_,
                  [&](std::size_t step) { return grid.nearest(longitude, latitude, level, step); });
    };
    const double t = mean_of(temperature_), s = mean_of(salinity_);
    if (std::isnan(t) || std::isnan(s)) break;
    column.depth.push_back(temperature_.depths()[level]);
    column.temperature.push_back(t - zero_);
    column.salinity.push_back(s);
  }
  return column;
}

}  // namespace asdic::detail::climatology
