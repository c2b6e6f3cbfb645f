#include "io/climatology/tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/climatology/ascii_grid.h"
#include "io/climatology/netcdf_file.h"
#include "io/climatology/raster_source.h"
#include "io/climatology/words.h"
#include "raytrace/area/map_frame.h"

namespace asdic::detail::climatology {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const UnitRule metres_rule{{"m", "metre", "metres", "meter", "meters"}};
const std::vector<UnitRule> speed_rules{
    {{"m/s", "m s-1", "m s**-1", "m s^-1", "ms-1", "meter/second", "meters/second", "metre/second",
      "meter second-1", "m.s-1"}},
    {{"knots", "knot", "kn", "kt"}, 1852.0 / 3600.0},
    {{"cm/s", "cm s-1"}, 0.01},
    {{"km/h"}, 1.0 / 3.6}};

}  // namespace

const GriddedQuantity& temperature_quantity() {
  static const GriddedQuantity quantity{
      "temperature",
      {"sea_water_temperature", "TEMP", "temperature", "t_an", "water_temp",
       "sea_water_potential_temperature", "sea_water_conservative_temperature", "thetao",
       "votemper", "theta", "pt", "CT"},
      {{{"degc", "deg c", "deg_c", "degree_c", "degrees_c", "degree c", "degrees c", "celsius",
         "degree_celsius", "degrees_celsius", "degree celsius", "degrees celsius", "deg celsius",
         "celsius_scale", "c", "\u00b0c"}},
       {{"k", "kelvin", "degk", "deg k", "degrees_k", "degree_kelvin"}, 1.0, -273.15}},
      "degC"};
  return quantity;
}

const GriddedQuantity& salinity_quantity() {
  static const GriddedQuantity quantity{
      "salinity",
      {"sea_water_practical_salinity", "sea_water_salinity", "sea_water_absolute_salinity", "SALT",
       "salinity", "s_an", "so", "vosaline", "PSAL", "SA"},
      {{{"psu", "pss", "pss-78", "pss78", "ppt", "1", "1e-3", "0.001", "1.e-3", "practical",
         "practical_salinity", "unitless", "dimensionless", "g/kg", "g kg-1", "g kg**-1", "o/oo",
         "p.s.u.", "psal"}}},
      "psu"};
  return quantity;
}

const GriddedQuantity& sound_speed_quantity() {
  static const GriddedQuantity quantity{
      "sound speed",
      {"speed_of_sound_in_sea_water", "sound_speed", "soundspeed", "sound_velocity", "svel", "c"},
      speed_rules,
      "m/s"};
  return quantity;
}

const GriddedQuantity& bathymetry_quantity() {
  static const GriddedQuantity quantity{
      "bathymetry",
      {"ROSE", "elevation", "height_above_reference_ellipsoid", "height_above_mean_sea_level",
       "surface_altitude", "altitude", "topo", "bath", "bathymetry", "z",
       "sea_floor_depth_below_geoid", "sea_floor_depth_below_sea_surface",
       "sea_floor_depth_below_mean_sea_level", "sea_floor_depth", "deptho", "depth"},
      {metres_rule, {{"km", "kilometre", "kilometres", "kilometer", "kilometers"}, 1000.0}},
      "m"};
  return quantity;
}

const GriddedQuantity& wind_speed_quantity() {
  static const GriddedQuantity quantity{
      "wind", {"wind_speed", "WSPD", "windspeed", "si10", "sfcWind", "wind"}, speed_rules, "m/s"};
  return quantity;
}

const GriddedQuantity& eastward_wind_quantity() {
  static const GriddedQuantity quantity{
      "wind",
      {"eastward_wind", "UWND", "u10", "uas", "10m_u_component_of_wind"},
      speed_rules,
      "m/s"};
  return quantity;
}

const GriddedQuantity& northward_wind_quantity() {
  static const GriddedQuantity quantity{
      "wind",
      {"northward_wind", "VWND", "v10", "vas", "10m_v_component_of_wind"},
      speed_rules,
      "m/s"};
  return quantity;
}

const GriddedQuantity& sediment_quantity() {
  static const GriddedQuantity quantity{
      "sediment",
      {"grain_size", "mean_grain_size", "mz", "phi", "sediment", "sediment_class", "seabed",
       "substrate", "lithology", "class"},
      {{{"phi", "1", "class", "classes", "dimensionless"}}},
      "phi"};
  return quantity;
}

namespace {

std::vector<std::string> names_wanted(const DataFile& file, const GriddedQuantity& quantity) {
  return file.variable.empty() ? quantity.names : std::vector{file.variable};
}

/// Whether a band says that it is another quantity: "u10" is no wind speed.
bool is_another(const DataGrid& grid, const GriddedQuantity& quantity) {
  const auto called = [&](const GriddedQuantity& one) {
    return std::any_of(one.names.begin(), one.names.end(), [&](const std::string& name) {
      return lower(name) == lower(grid.long_name()) || lower(name) == lower(grid.standard_name());
    });
  };
  const GriddedQuantity* const all[] = {&temperature_quantity(), &salinity_quantity(),
                                        &sound_speed_quantity(), &bathymetry_quantity(),
                                        &wind_speed_quantity(),  &eastward_wind_quantity(),
                                        &sediment_quantity(),    &northward_wind_quantity()};
  return !called(quantity) &&
         std::any_of(std::begin(all), std::end(all), [&](const auto* one) { return called(*one); });
}

std::optional<DataGrid> find_grid(const DataFile& file, const GriddedQuantity& quantity,
                                  bool required) {
  if (raster_kind(file.path)) {
    auto grid = DataGrid::of(file.path,
                             open_raster(file.path, {.named = file.variable,
                                                     .names = quantity.names,
                                                     .colours = &quantity == &sediment_quantity(),
                                                     .required = required}));
    if (grid && file.variable.empty() && is_another(*grid, quantity)) return std::nullopt;
    return grid;
  }
  if (auto ascii = read_ascii_grid(file.path)) return ascii;
  return DataGrid::find(file.path, names_wanted(file, quantity));
}

/// What to name of a file that has not got what was asked for: the variables that it has.
std::string variables_wanted(const DataFile& file, const GriddedQuantity& quantity) {
  constexpr std::size_t most = 8;
  const bool raster = raster_kind(file.path).has_value();
  const std::vector<std::string> names = raster ? quantity.names : netcdf_variables(file.path);
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    list += (i > 0 ? ", " : "") + names[i];
  if (names.size() > most) list += ", ...";
  if (names.empty()) return "a file with variables on a grid";
  if (raster) return "a band with a description such as " + list + ", or FILE:BAND";
  if (!file.variable.empty()) return "one of " + list + ", or FILE:VARIABLE of another file";
  return "a usual name or standard_name of it, or FILE:VARIABLE with one of " + list;
}

double mean_step(const std::vector<double>& axis) {
  if (axis.size() < 2) return 1.0;
  return std::abs(axis.back() - axis.front()) / static_cast<double>(axis.size() - 1);
}

double weighted_mean(const std::vector<Tiles::Weighted>& all) {
  double sum = 0.0, weights = 0.0;
  for (const auto& [value, weight] : all) {
    if (std::isnan(value)) continue;
    sum += weight * value;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : unknown;
}

/// The same meridian, within half a turn of another.
double near_longitude(double longitude, double other) {
  return longitude + 360.0 * std::round((other - longitude) / 360.0);
}

}  // namespace

DataGrid require_grid(const DataFile& file, const GriddedQuantity& quantity, bool projected) {
  if (!std::filesystem::exists(file.path))
    throw InputError({.where = file.path.string(),
                      .got = "no such file",
                      .expected = "a netCDF file of " + quantity.name +
                                  " (install Debian's ferret-datasets: scripts/setup.sh "
                                  "--climatology, or name a file of your own)"});
  auto grid = find_grid(file, quantity, true);
  if (!grid)
    throw InputError({.where = file.path.string(),
                      .got = file.variable.empty() ? "no variable of " + quantity.name
                                                   : "no variable " + in_quotes(file.variable),
                      .expected = variables_wanted(file, quantity)});
  if (!grid->geographic() && !projected)
    throw InputError(
        {.where = file.path.string() + ": " + grid->variable(),
         .got = "a grid on projected x and y" +
                (grid->projection_name().empty() ? std::string() : ": " + grid->projection_name()),
         .expected = grid->projection_name().empty()
                         ? "one on longitude and latitude"
                         : "one on longitude and latitude: \"gdalwarp -t_srs "
                           "EPSG:4326 IN OUT\" makes it"});
  return std::move(*grid);
}

UnitRule rule_of(const DataGrid& grid, const GriddedQuantity& quantity,
                 std::vector<std::string>& remarks) {
  std::string unit = lower(grid.units());
  unit.erase(0, unit.find_first_not_of(' '));
  unit.erase(unit.find_last_not_of(' ') + 1);
  const std::string where = grid.path().filename().string() + ": " + grid.variable();
  remarks.insert(remarks.end(), grid.remarks().begin(), grid.remarks().end());
  if (unit.empty()) {
    if (quantity.name != "sediment")
      remarks.push_back(where + " has no units: taken as " + quantity.unit);
    return quantity.rules.front();
  }
  for (const UnitRule& rule : quantity.rules)
    if (std::find(rule.units.begin(), rule.units.end(), unit) != rule.units.end()) return rule;
  std::string known;
  for (const UnitRule& rule : quantity.rules) known += (known.empty() ? "" : ", ") + rule.units[0];
  throw InputError({.where = grid.path().string() + ": " + grid.variable(),
                    .got = "units of " + in_quotes(grid.units()),
                    .expected = quantity.name + " in one of " + known});
}

bool has_quantity(const std::vector<DataFile>& files, const GriddedQuantity& quantity) {
  if (files.empty() || !std::filesystem::exists(files[0].path)) return true;
  return find_grid(files[0], quantity, false).has_value();
}

Tiles::Tiles(const std::vector<DataFile>& files, const GriddedQuantity& quantity,
             const OceanTime& when)
    : quantity_(quantity) {
  for (const DataFile& file : files) {
    DataGrid grid = require_grid(file, quantity);
    files_.push_back({file.path, grid.variable()});
    const UnitRule rule = rule_of(grid, quantity, remarks_);
    const auto same = std::find_if(tiles_.begin(), tiles_.end(), [&](const Tile& tile) {
      const DataGrid& other = tile.grids[0];
      return other.eastings() == grid.eastings() && other.northings() == grid.northings() &&
             other.depths() == grid.depths() && tile.rule.units == rule.units;
    });
    if (same != tiles_.end()) {
      same->grids.push_back(std::move(grid));
      continue;
    }
    Tile& tile = tiles_.emplace_back();
    tile.rule = rule;
    tile.step_east = mean_step(grid.eastings());
    tile.step_north = mean_step(grid.northings());
    tile.grids.push_back(std::move(grid));
  }
  for (Tile& tile : tiles_) {
    try {
      tile.time = choose_steps(tile.grids, when);
    } catch (const InputError& error) {
      tile.fault = error.fault();
    }
  }
  if (std::all_of(tiles_.begin(), tiles_.end(), [](const Tile& t) { return t.fault.has_value(); }))
    throw InputError(*tiles_.front().fault);
  std::stable_sort(tiles_.begin(), tiles_.end(), [](const Tile& a, const Tile& b) {
    if (a.fault.has_value() != b.fault.has_value()) return !a.fault.has_value();
    if (a.time.fit != b.time.fit) return a.time.fit < b.time.fit;
    return a.step_north < 0.99 * b.step_north;
  });
}

bool Tiles::holds(const Tile& tile, double latitude, double longitude) const {
  return tile.grids[0].nearest_point(longitude, latitude).has_value();
}

const Tiles::Tile* Tiles::tile_at(double latitude, double longitude) const {
  for (const Tile& tile : tiles_) {
    if (!holds(tile, latitude, longitude)) continue;
    if (tile.fault) throw InputError(*tile.fault);
    return &tile;
  }
  return nullptr;
}

bool Tiles::holds(double latitude, double longitude) const {
  return std::any_of(tiles_.begin(), tiles_.end(),
                     [&](const Tile& tile) { return holds(tile, latitude, longitude); });
}

std::string Tiles::name_at(double latitude, double longitude) const {
  for (const Tile& tile : tiles_)
    if (holds(tile, latitude, longitude))
      return tile.grids[0].path().string() + ": " + tile.grids[0].variable();
  return first().path().string() + ": " + first().variable();
}

std::string Tiles::short_name_at(double latitude, double longitude) const {
  for (const Tile& tile : tiles_)
    if (holds(tile, latitude, longitude))
      return tile.grids[0].path().filename().string() + ": " + tile.grids[0].variable();
  return first().path().filename().string() + ": " + first().variable();
}

void Tiles::check_holds(double latitude, double longitude) const {
  if (holds(latitude, longitude)) return;
  std::string reach;
  for (const Tile& tile : tiles_) {
    const auto range = [](const std::vector<double>& axis) {
      return to_text(std::min(axis.front(), axis.back())) + " to " +
             to_text(std::max(axis.front(), axis.back()));
    };
    reach += (reach.empty() ? "" : "; ") + range(tile.grids[0].northings()) + " N, " +
             range(tile.grids[0].eastings()) + " E";
  }
  throw InputError({.where = name_at(latitude, longitude),
                    .got = place(latitude, longitude) + ", out of its grid (" + reach + ")",
                    .expected = "a file of " + quantity_.name + " that holds the place"});
}

std::vector<Tiles::Weighted> Tiles::bilinear_steps(double latitude, double longitude) const {
  const Tile* const tile = tile_at(latitude, longitude);
  if (tile == nullptr) return {};
  const auto& xs = tile->grids[0].eastings();
  const auto& ys = tile->grids[0].northings();
  const double low_x = std::min(xs.front(), xs.back()), high_x = std::max(xs.front(), xs.back());
  const double low_y = std::min(ys.front(), ys.back()), high_y = std::max(ys.front(), ys.back());
  const double x = near_longitude(longitude, 0.5 * (low_x + high_x));
  const auto converted = [&](double value) { return value * tile->rule.scale + tile->rule.offset; };
  const bool inside_x = tile->grids[0].wraps() || (x >= low_x && x <= high_x);
  if (inside_x && latitude >= low_y && latitude <= high_y) {
    std::vector<Weighted> all;
    for (const auto& part : tile->time.parts)
      all.push_back({converted(tile->grids[part.file].bilinear(longitude, latitude, 0, part.step)),
                     part.weight});
    return all;
  }
  // In the half step about the tile: the points beyond are those of another tile, if there is one.
  const auto cell = [](double value, double low, double high, double step) {
    const double begin = value < low    ? low - step
                         : value > high ? high
                                        : low + step * std::floor((value - low) / step);
    return std::pair(begin, (value - begin) / step);
  };
  const auto [x0, u] = cell(x, low_x, high_x, tile->step_east);
  const auto [y0, v] = cell(latitude, low_y, high_y, tile->step_north);
  std::vector<Weighted> corners;
  for (const bool east : {false, true})
    for (const bool north : {false, true}) {
      const double weight = (east ? u : 1.0 - u) * (north ? v : 1.0 - v);
      const double lon = x0 + (east ? tile->step_east : 0.0),
                   lat = y0 + (north ? tile->step_north : 0.0);
      // Half a step out, its own edge would answer for the point beyond: others are asked first.
      const Tile* there = nullptr;
      const bool own = (tile->grids[0].wraps() || (lon >= low_x - 1e-6 && lon <= high_x + 1e-6)) &&
                       lat >= low_y - 1e-6 && lat <= high_y + 1e-6;
      if (own) there = tile;
      for (const Tile& other : tiles_)
        if (there == nullptr && &other != tile && !other.fault && holds(other, lat, lon))
          there = &other;
      if (there == nullptr || weight <= 0.0) continue;
      std::vector<Weighted> steps;
      for (const auto& part : there->time.parts)
        steps.push_back(
            {there->grids[part.file].nearest(lon, lat, 0, part.step) * there->rule.scale +
                 there->rule.offset,
             part.weight});
      corners.push_back({weighted_mean(steps), weight});
    }
  return {{weighted_mean(corners), 1.0}};
}

double Tiles::bilinear(double latitude, double longitude) const {
  return weighted_mean(bilinear_steps(latitude, longitude));
}

double Tiles::nearest(double latitude, double longitude) const {
  const Tile* const tile = tile_at(latitude, longitude);
  if (tile == nullptr) return unknown;
  std::vector<Weighted> steps;
  for (const auto& part : tile->time.parts)
    steps.push_back(
        {tile->grids[part.file].nearest(longitude, latitude, 0, part.step) * tile->rule.scale +
             tile->rule.offset,
         part.weight});
  return weighted_mean(steps);
}

DataGrid::Block Tiles::read_block(const Tile& tile, DataGrid::Indices east, DataGrid::Indices north,
                                  DataGrid::Indices levels) const {
  DataGrid::Block sum;
  std::vector<double> weights;
  for (const auto& part : tile.time.parts) {
    DataGrid::Block one = tile.grids[part.file].block(east, north, levels, part.step);
    if (weights.empty()) {
      weights.assign(one.values.size(), 0.0);
      sum = one;
      sum.values.assign(one.values.size(), 0.0);
    }
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      if (std::isnan(one.values[i])) continue;
      sum.values[i] += part.weight * one.values[i];
      weights[i] += part.weight;
    }
  }
  for (std::size_t i = 0; i < sum.values.size(); ++i)
    sum.values[i] = weights[i] > 0.0
                        ? sum.values[i] / weights[i] * tile.rule.scale + tile.rule.offset
                        : unknown;
  return sum;
}

std::vector<double> Tiles::read_column(const Tile& tile, DataGrid::Point point) const {
  const std::size_t levels = std::max<std::size_t>(tile.grids[0].depths().size(), 1);
  return read_block(tile, {point.i, point.i}, {point.j, point.j}, {0, levels - 1}).values;
}

std::optional<Tiles::Where> Tiles::where(double latitude, double longitude) const {
  const Tile* const tile = tile_at(latitude, longitude);
  if (tile == nullptr) return std::nullopt;
  return Where{static_cast<std::size_t>(tile - tiles_.data()),
               *tile->grids[0].nearest_point(longitude, latitude)};
}

std::optional<Tiles::Column> Tiles::column(double latitude, double longitude) const {
  const auto here = where(latitude, longitude);
  if (!here) return std::nullopt;
  Column column{.tile = here->tile, .point = here->point};
  const auto add = [&](const Tile& tile, DataGrid::Point point) {
    const auto& depths = tile.grids[0].depths();
    const std::vector<double> values = read_column(tile, point);
    const double last = column.depths.empty() ? -1e30 : column.depths.back();
    bool some = false;
    for (std::size_t level = 0; level < depths.size(); ++level) {
      if (depths[level] <= last) continue;
      if (std::isnan(values[level])) break;
      column.depths.push_back(depths[level]);
      column.values.push_back(values[level]);
      some = true;
    }
    return some;
  };
  add(tiles_[here->tile], here->point);
  // Levels below: World Ocean Atlas' months end at 1500 m, its seasons and its year go on.
  for (std::size_t t = 0; t < tiles_.size() && !column.depths.empty(); ++t) {
    const Tile& tile = tiles_[t];
    if (t == here->tile || tile.fault || tile.grids[0].depths().empty()) continue;
    if (tile.grids[0].depths().back() <= column.depths.back()) continue;
    const auto point = tile.grids[0].nearest_point(longitude, latitude);
    const double end = column.depths.back();
    if (!point || !add(tile, *point)) continue;
    column.continued = "below " + to_text(std::round(10.0 * end) / 10.0) + " m the " +
                       quantity_.name + " is that of " + tile.grids[0].path().filename().string() +
                       " (" + tile.time.said + ")";
  }
  return column;
}

double Tiles::spacing(double latitude, double longitude, double bearing_deg) const {
  const Tile* tile = tile_at(latitude, longitude);
  if (tile == nullptr) tile = &tiles_.front();
  const double degree = MapFrame::earth_radius * radians(1.0), theta = radians(bearing_deg);
  const double east = tile->step_east * degree * std::cos(radians(latitude)),
               north = tile->step_north * degree;
  const double meets = std::max(std::abs(std::sin(theta)) / std::max(east, 1.0),
                                std::abs(std::cos(theta)) / std::max(north, 1.0));
  return 1.0 / meets;
}

std::optional<Tiles::GridPlace> Tiles::grid_place(double latitude, double longitude) const {
  for (const Tile& tile : tiles_) {
    if (tile.fault || !holds(tile, latitude, longitude)) continue;
    const auto& xs = tile.grids[0].eastings();
    const auto& ys = tile.grids[0].northings();
    const double west = std::min(xs.front(), xs.back()), south = std::min(ys.front(), ys.back());
    const double middle = 0.5 * (xs.front() + xs.back());
    return GridPlace{static_cast<std::size_t>(&tile - tiles_.data()),
                     (near_longitude(longitude, middle) - west) / tile.step_east,
                     (latitude - south) / tile.step_north};
  }
  return std::nullopt;
}

const TimeChoice& Tiles::time_at(double latitude, double longitude) const {
  const Tile* const tile = tile_at(latitude, longitude);
  return tile == nullptr ? tiles_.front().time : tile->time;
}

const std::vector<double>& Tiles::levels() const { return first().depths(); }

DataGrid::Block Tiles::crop(double south, double north, double west, double east,
                            bool values) const {
  const double mid_x = 0.5 * (west + east), mid_y = 0.5 * (south + north);
  const Tile* base = tile_at(mid_y, mid_x);
  if (base == nullptr) {
    check_holds(mid_y, mid_x);
    base = &tiles_.front();
  }
  const double dx = base->step_east, dy = base->step_north;
  const double x0 = base->grids[0].eastings()[0], y0 = base->grids[0].northings()[0];
  const auto off_line = [](double value, double first, double step) {
    const double steps = (value - first) / step;
    return std::abs(steps - std::round(steps));
  };
  const auto alike = [&](const Tile& tile) {  // goes on with the lines of the base
    const DataGrid& grid = tile.grids[0];
    return !tile.fault && tile.time.fit == base->time.fit &&
           std::abs(tile.step_north / dy - 1.0) < 0.01 &&
           std::abs(tile.step_east / dx - 1.0) < 0.01 &&
           off_line(near_longitude(grid.eastings()[0], x0), x0, dx) < 0.1 &&
           off_line(grid.northings()[0], y0, dy) < 0.1;
  };
  // Indices of an axis that lie in the box, as runs, and where they are.
  struct Run {
    DataGrid::Indices indices;
  };
  const auto runs_of = [](const std::vector<double>& axis, double low, double high, double turn,
                          auto&& at) {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      const double x = at(axis[i]);
      if (x < low || x > high) continue;
      const bool goes_on = !runs.empty() && runs.back().indices.last + 1 == i &&
                           std::abs(x - at(axis[i - 1])) < turn;
      if (goes_on)
        runs.back().indices.last = i;
      else
        runs.push_back({{i, i}});
    }
    return runs;
  };
  const auto longitude = [&](double x) { return near_longitude(x, mid_x); };
  const auto latitude = [](double y) { return y; };
  const auto key_x = [&](double x) { return std::lround((longitude(x) - longitude(x0)) / dx); };
  const auto key_y = [&](double y) { return std::lround((y - y0) / dy); };
  std::map<long, double> xs, ys;
  for (const Tile& tile : tiles_) {
    if (!alike(tile)) continue;
    const auto columns = runs_of(tile.grids[0].eastings(), west - dx, east + dx, 180.0, longitude);
    const auto rows = runs_of(tile.grids[0].northings(), south - dy, north + dy, 180.0, latitude);
    if (columns.empty() || rows.empty()) continue;
    for (const Run& run : columns)
      for (std::size_t i = run.indices.first; i <= run.indices.last; ++i)
        xs.emplace(key_x(tile.grids[0].eastings()[i]), longitude(tile.grids[0].eastings()[i]));
    for (const Run& run : rows)
      for (std::size_t j = run.indices.first; j <= run.indices.last; ++j)
        ys.emplace(key_y(tile.grids[0].northings()[j]), tile.grids[0].northings()[j]);
  }
  DataGrid::Block all;
  std::map<long, std::size_t> column_of, row_of;
  for (const auto& [k, x] : xs) {
    column_of[k] = all.eastings.size();
    all.eastings.push_back(x);
  }
  for (const auto& [k, y] : ys) {
    row_of[k] = all.northings.size();
    all.northings.push_back(y);
  }
  if (!values) return all;
  all.values.assign(all.eastings.size() * all.northings.size(), unknown);
  for (const Tile& tile : tiles_) {
    if (!alike(tile)) continue;
    for (const Run& row :
         runs_of(tile.grids[0].northings(), south - dy, north + dy, 180.0, latitude))
      for (const Run& run :
           runs_of(tile.grids[0].eastings(), west - dx, east + dx, 180.0, longitude)) {
        const auto block = read_block(tile, run.indices, row.indices, {0, 0});
        for (std::size_t j = 0; j < block.northings.size(); ++j)
          for (std::size_t i = 0; i < block.eastings.size(); ++i) {
            const std::size_t column = column_of.at(key_x(block.eastings[i])),
                              line = row_of.at(key_y(block.northings[j]));
            double& value = all.values[line * all.eastings.size() + column];
            if (std::isnan(value)) value = block.at(i, j);
          }
      }
  }
  return all;
}

}  // namespace asdic::detail::climatology
