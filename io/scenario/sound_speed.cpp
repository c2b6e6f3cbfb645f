#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/columns.h"
#include "io/scenario/ocean.h"
#include "io/scenario/sections.h"
#include "raytrace/ocean/seawater.h"
#include "raytrace/warnings/warnings.h"

namespace asdic::scenario {
namespace {

/// A fault of the samples together (a spline that swings too far) is told at the table's key.
SoundSpeedProfile profile_of(const TomlTable& table, const std::vector<double>& depth,
                             const std::vector<double>& speed, Interpolation interpolation) {
  try {
    return SoundSpeedProfile::table(depth, speed, interpolation);
  } catch (const InputError& error) {
    throw table.fault(error.fault().where, error.fault().expected, error.fault().got);
  }
}

/// A short table goes on by the law of its first or last interval, as far as that makes sense: its
/// speed at both boundaries must be near what the samples hold.
void check_reach(const TomlTable& table, const std::string& key, std::span<const double> depth,
                 std::span<const double> speed, const Environment& ocean) {
  const auto [least, most] = std::minmax_element(speed.begin(), speed.end());
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  const double surface =
      ocean.surface.shape ? ocean.surface.shape->shallowest() : ocean.surface.depth;
  const auto ranges = ocean.section ? ocean.section->ranges() : std::span<const double>();
  for (const double z : {surface, bottom})
    for (std::size_t i = 0; i < std::max<std::size_t>(1, ranges.size()); ++i) {
      const double c = ocean.section ? ocean.section->at(ranges[i], z).c : ocean.water.at(z).c;
      if (!(c > 0.8 * *least && c < 1.25 * *most))
        throw table.fault(
            key, "levels that reach from the surface to the bottom at " + to_text(bottom) + " m",
            "levels from " + to_text(depth.front()) + " to " + to_text(depth.back()) +
                " m, by which the speed at " + to_text(z) + " m would be " +
                to_text(std::round(c)) + " m/s");
    }
}

void read_table(TomlTable& table, const OceanReading& reading, Interpolation interpolation,
                Environment& ocean) {
  const Columns columns = read_columns(
      table, reading.folder, {{"depth", quantity::water_depth}, {"speed", quantity::sound_speed}});
  require_increasing(columns);
  ocean.water = profile_of(table, columns.values[0], columns.values[1], interpolation);
  check_reach(table, table.has("file") ? "file" : "depth", columns.values[0], columns.values[1],
              ocean);
}

/// `range`, `depth` and rows of `speed`; or a CSV file with a line for every point of the grid.
SoundSpeedSection read_grid(TomlTable& table, const OceanReading& reading) {
  if (!table.has("file")) {
    const std::vector<double> range = table.numbers("range", quantity::range);
    const std::vector<double> depth = table.numbers("depth", quantity::water_depth);
    const auto rows = table.rows("speed", quantity::sound_speed);
    if (rows.size() != range.size())
      throw table.fault("speed",
                        "a row for each of the " + std::to_string(range.size()) + " ranges",
                        std::to_string(rows.size()) + " rows");
    if (rows[0].size() != depth.size())
      throw table.fault("speed[0]",
                        "a speed for each of the " + std::to_string(depth.size()) + " depths");
    std::vector<double> speed;
    for (const auto& row : rows) speed.insert(speed.end(), row.begin(), row.end());
    try {
      return SoundSpeedSection(range, depth, speed);
    } catch (const InputError& error) {
      throw table.fault(error.fault().where, error.fault().expected, error.fault().got);
    }
  }
  const Columns columns = read_columns(table, reading.folder,
                                       {{"range", quantity::range},
                                        {"depth", quantity::water_depth},
                                        {"speed", quantity::sound_speed}});
  const auto& r = columns.values[0];
  const auto& z = columns.values[1];
  const auto distinct = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
  };
  const std::vector<double> range = distinct(r), depth = distinct(z);
  constexpr std::size_t few = 1'000'000;  // gaps are looked for, place by place
  if (const std::size_t places = range.size() * depth.size();
      places > few && places > columns.rows())
    throw table.fault("file", "a speed at every depth of every range",
                      std::to_string(columns.rows()) + " speeds for " +
                          std::to_string(range.size()) + " ranges and " +
                          std::to_string(depth.size()) + " depths");
  std::vector<double> speed(range.size() * depth.size(), 0.0);
  const auto place = [](const std::vector<double>& axis, double value) {
    return static_cast<std::size_t>(std::lower_bound(axis.begin(), axis.end(), value) -
                                    axis.begin());
  };
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    double& c = speed[place(range, r[row]) * depth.size() + place(depth, z[row])];
    if (c != 0.0)
      throw columns.fault(0, row,
                          "one speed a point, not a second one at " + to_text(z[row]) + " m", "m");
    c = columns.values[2][row];
  }
  for (std::size_t i = 0; i < speed.size(); ++i)
    if (speed[i] == 0.0)
      throw table.fault("file", "a speed at every depth of every range",
                        "none at range " + to_text(range[i / depth.size()]) + " m, depth " +
                            to_text(depth[i % depth.size()]) + " m");
  if (depth.size() < 2) throw table.fault("file", "at least two depths", "one");
  return {range, depth, speed};
}

void read_section(TomlTable& table, const OceanReading& reading, Environment& ocean) {
  ocean.section = read_grid(table, reading);
  const auto depth = ocean.section->depths();
  std::vector<double> at_start;
  for (const double z : depth) at_start.push_back(ocean.section->at(0.0, z).c);
  ocean.water = SoundSpeedProfile::table(depth, at_start, Interpolation::c_linear);
  check_reach(table, table.has("file") ? "file" : "depth", depth, ocean.section->speeds(), ocean);
}

/// A warning when an equation is asked about water that it was not measured in: temperature,
/// salinity and depth of all levels. \param latitude_deg  for the pressure
void note_range(SeawaterEquation equation, std::span<const double> depth,
                std::span<const double> temperature, std::span<const double> salinity,
                double latitude_deg, std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < temperature.size(); ++i) {
    const double megapascal = 1e-6 * gauge_pressure(depth[i], latitude_deg);
    const std::array<Asked, 4> asked{{{"temperature", temperature[i], temperature[i]},
                                      {"salinity", salinity[i], salinity[i]},
                                      {"depth", depth[i], depth[i]},
                                      {"pressure", megapascal, megapascal}}};
    const std::string text = outside(validity(equation), asked);
    if (text.empty()) continue;
    notes.push_back("environment.sound_speed: at " + to_text(depth[i]) + " m " + text);
    return;
  }
}

SoundSpeedProfile read_temperature_salinity(TomlTable& table, const OceanReading& reading,
                                            Interpolation interpolation, const Environment& ocean) {
  const double bottom_depth =
      ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  static const std::array<std::pair<std::string, SeawaterEquation>, 3> equations{
      {{"chen-millero", SeawaterEquation::chen_millero},
       {"mackenzie", SeawaterEquation::mackenzie},
       {"del-grosso", SeawaterEquation::del_grosso}}};
  const std::string name = table.choice(
      "equation", {equations[0].first, equations[1].first, equations[2].first}, "chen-millero");
  const SeawaterEquation equation =
      std::find_if(equations.begin(), equations.end(), [&](const auto& e) {
        return e.first == name;
      })->second;
  const double latitude =
      table.number("latitude_deg",
                   {.noun = "latitude", .unit = "degrees north", .low = -90.0, .high = 90.0}, 45.0);
  const Columns columns = read_columns(table, reading.folder,
                                       {{"depth", quantity::depth},
                                        {"temperature", quantity::temperature},
                                        {"salinity", quantity::salinity}});
  require_increasing(columns);
  note_range(equation, columns.values[0], columns.values[1], columns.values[2], latitude,
             reading.notes);
  add_warnings({checks::profile_reach(columns.values[0].front(), columns.values[0].back(), ocean,
                                      "the water is like that at the first and last")},
               reading.notes);
  std::vector<double> depth, speed;
  const auto add = [&](double z, std::size_t level) {
    depth.push_back(z);
    speed.push_back(
        sound_speed(equation, columns.values[1][level], columns.values[2][level], z, latitude));
  };
  // Water above the first and below the last level is like that level, but under its own pressure:
  // levels at most 250 m apart keep the pressure's part of the gradient.
  const std::vector<double>& given = columns.values[0];
  if (given.front() > 0.0) add(0.0, 0);
  for (std::size_t level = 0; level < given.size(); ++level) add(given[level], level);
  const double rest = std::max(0.0, bottom_depth - given.back());
  const auto extra = static_cast<int>(std::ceil(rest / 250.0));
  for (int i = 1; i <= extra; ++i) add(given.back() + rest * i / extra, given.size() - 1);
  return profile_of(table, depth, speed, interpolation);
}

}  // namespace

void read_sound_speed(TomlTable table, const OceanReading& reading, Environment& ocean) {
  const std::string kind =
      table.choice("kind", {"table", "munk", "isovelocity", "temperature-salinity", "section"});
  Interpolation interpolation = Interpolation::c_linear;
  if (kind == "table" || kind == "temperature-salinity") {
    const std::string law = table.choice(
        "interpolation", {"c-linear", "n2-linear", "spline", "pchip", "pchip-spline-slopes"},
        "c-linear");
    for (const Interpolation rule : {Interpolation::n2_linear, Interpolation::spline,
                                     Interpolation::pchip, Interpolation::pchip_spline_slopes})
      if (law == name(rule)) interpolation = rule;
  }
  if (kind == "table") {
    read_table(table, reading, interpolation, ocean);
  } else if (kind == "temperature-salinity") {
    ocean.water = read_temperature_salinity(table, reading, interpolation, ocean);
  } else if (kind == "section") {
    read_section(table, reading, ocean);
  } else if (kind == "isovelocity") {
    ocean.water = SoundSpeedProfile::isovelocity(table.number("speed", quantity::sound_speed));
  } else {
    MunkParameters munk;
    munk.axis_speed = table.number("axis_speed", quantity::sound_speed, munk.axis_speed);
    munk.axis_depth = table.number("axis_depth", quantity::depth, munk.axis_depth);
    munk.scale_depth = table.number(
        "scale_depth", {.noun = "depth", .unit = "m", .low = 10.0, .high = 1e5}, munk.scale_depth);
    munk.perturbation = table.number("perturbation", {.low = 0.0, .high = 0.1}, munk.perturbation);
    ocean.water = SoundSpeedProfile::munk(munk);
  }
  table.finish();
}

}  // namespace asdic::scenario
