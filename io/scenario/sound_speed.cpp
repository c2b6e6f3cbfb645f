#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "io/scenario/sections.h"
#include "io/text/csv_table.h"
#include "io/text/quote.h"
#include "raytrace/ocean/seawater.h"

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

constexpr Quantity temperature_quantity{
    .noun = "temperature", .unit = "degC", .low = -3.0, .high = 45.0};
constexpr Quantity salinity_quantity{.noun = "salinity", .unit = "psu", .low = 0.0, .high = 50.0};

/// Columns of a profile and where each number came from.
struct Columns {
  std::vector<std::vector<double>> values;  // [names][levels]
  TomlTable* table = nullptr;
  std::string csv_file;  // "" when they stand in the scenario itself
  std::vector<int> csv_lines;
  std::vector<std::string> names;

  [[nodiscard]] std::size_t levels() const { return values[0].size(); }

  [[nodiscard]] InputError fault(std::size_t column, std::size_t level, const std::string& expected,
                                 std::string_view unit) const {
    const std::string got = to_text(values[column][level]) + " " + std::string(unit);
    if (csv_file.empty())
      return table->fault(names[column] + "[" + std::to_string(level) + "]", expected, got);
    return InputError(
        {.where = csv_file + ":" + std::to_string(csv_lines[level]) + ": " + names[column],
         .got = got,
         .expected = expected});
  }
};

/// `depth` and its companions, from the scenario's arrays or from the CSV file that it names.
Columns read_columns(TomlTable& table, const std::filesystem::path& folder,
                     const std::vector<std::pair<std::string, Quantity>>& wanted) {
  Columns columns;
  columns.table = &table;
  for (const auto& [name, quantity] : wanted) columns.names.push_back(name);
  if (table.has("file")) {
    const std::filesystem::path path = folder / table.text("file");
    if (!std::filesystem::exists(path))
      throw table.fault("file", "a readable CSV file", "no such file " + in_quotes(path.string()));
    const CsvTable csv = read_csv(path);
    columns.csv_file = csv.file;
    columns.csv_lines = csv.lines;
    for (const std::string& name : columns.names) columns.values.push_back(csv.column(name));
  } else {
    for (const auto& [name, quantity] : wanted)
      columns.values.push_back(table.numbers(name, quantity));
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto& [name, quantity] = wanted[i];
    if (columns.values[i].size() != columns.levels())
      throw table.fault(name, "as many values as depths, " + std::to_string(columns.levels()));
    for (std::size_t level = 0; level < columns.levels(); ++level) {
      const double value = columns.values[i][level];
      if (!quantity.holds(value)) throw columns.fault(i, level, quantity.expected(), quantity.unit);
      if (i == 0 && level > 0 && value <= columns.values[0][level - 1])
        throw columns.fault(
            i, level,
            "a depth below the one before it, " + to_text(columns.values[0][level - 1]) + " m",
            "m");
    }
  }
  return columns;
}

SoundSpeedProfile read_table(TomlTable& table, const std::filesystem::path& folder,
                             Interpolation interpolation, double bottom_depth) {
  const Columns columns =
      read_columns(table, folder, {{"depth", depth_quantity}, {"speed", speed_of_sound}});
  const auto& depth = columns.values[0];
  const auto& speed = columns.values[1];
  auto profile = profile_of(table, depth, speed, interpolation);
  // A short profile goes on by the law of its first or last interval, as far as that makes sense.
  const auto [least, most] = std::minmax_element(speed.begin(), speed.end());
  for (const double z : {0.0, bottom_depth}) {
    const double c = profile.at(z).c;
    if (!(c > 0.8 * *least && c < 1.25 * *most))
      throw table.fault(
          table.has("file") ? "file" : "depth",
          "levels that reach from the surface to the bottom at " + to_text(bottom_depth) + " m",
          "levels from " + to_text(depth.front()) + " to " + to_text(depth.back()) +
              " m, by which the speed at " + to_text(z) + " m would be " + to_text(std::round(c)) +
              " m/s");
  }
  return profile;
}

/// A note when an equation is asked about water that it was not measured in.
void note_range(const std::string& equation, std::span<const double> temperature,
                std::span<const double> salinity, std::vector<std::string>& notes) {
  struct Bounds {
    double coldest, warmest, freshest, saltiest;
  };
  const Bounds bounds = equation == "mackenzie"    ? Bounds{2.0, 30.0, 25.0, 40.0}
                        : equation == "del-grosso" ? Bounds{0.0, 30.0, 30.0, 40.0}
                                                   : Bounds{0.0, 40.0, 0.0, 40.0};
  for (std::size_t i = 0; i < temperature.size(); ++i) {
    if (temperature[i] >= bounds.coldest && temperature[i] <= bounds.warmest &&
        salinity[i] >= bounds.freshest && salinity[i] <= bounds.saltiest)
      continue;
    notes.push_back("environment.sound_speed: " + to_text(temperature[i]) + " degC and " +
                    to_text(salinity[i]) + " psu lie outside the range of " + equation + ", " +
                    to_text(bounds.coldest) + " to " + to_text(bounds.warmest) + " degC and " +
                    to_text(bounds.freshest) + " to " + to_text(bounds.saltiest) + " psu");
    return;
  }
}

SoundSpeedProfile read_temperature_salinity(TomlTable& table, const std::filesystem::path& folder,
                                            Interpolation interpolation, double bottom_depth,
                                            std::vector<std::string>& notes) {
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
  const Columns columns = read_columns(table, folder,
                                       {{"depth", depth_quantity},
                                        {"temperature", temperature_quantity},
                                        {"salinity", salinity_quantity}});
  note_range(name, columns.values[1], columns.values[2], notes);
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

SoundSpeedProfile read_sound_speed(TomlTable table, const std::filesystem::path& folder,
                                   double bottom_depth, std::vector<std::string>& notes) {
  const std::string kind =
      table.choice("kind", {"table", "munk", "isovelocity", "temperature-salinity"});
  Interpolation interpolation = Interpolation::c_linear;
  if (kind == "table" || kind == "temperature-salinity") {
    const std::string law =
        table.choice("interpolation", {"c-linear", "n2-linear", "spline", "pchip"}, "c-linear");
    if (law == "n2-linear") interpolation = Interpolation::n2_linear;
    if (law == "spline") interpolation = Interpolation::spline;
    if (law == "pchip") interpolation = Interpolation::pchip;
  }
  auto profile = SoundSpeedProfile::isovelocity(1500.0);
  if (kind == "table") {
    profile = read_table(table, folder, interpolation, bottom_depth);
  } else if (kind == "temperature-salinity") {
    profile = read_temperature_salinity(table, folder, interpolation, bottom_depth, notes);
  } else if (kind == "isovelocity") {
    profile = SoundSpeedProfile::isovelocity(table.number("speed", speed_of_sound));
  } else {
    MunkParameters munk;
    munk.axis_speed = table.number("axis_speed", speed_of_sound, munk.axis_speed);
    munk.axis_depth = table.number("axis_depth", depth_quantity, munk.axis_depth);
    munk.scale_depth = table.number(
        "scale_depth", {.noun = "depth", .unit = "m", .low = 10.0, .high = 1e5}, munk.scale_depth);
    munk.perturbation = table.number("perturbation", {.low = 0.0, .high = 0.1}, munk.perturbation);
    profile = SoundSpeedProfile::munk(munk);
  }
  table.finish();
  return profile;
}

}  // namespace asdic::scenario
