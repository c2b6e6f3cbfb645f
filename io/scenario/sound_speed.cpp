// Part of ocean.h: [environment.sound_speed].
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/ocean.h"
#include "io/settings/columns.h"
#include "io/settings/reader.h"
#include "raytrace/ocean/seawater.h"
#include "raytrace/warnings/warnings.h"

namespace asdic::detail {
namespace {

/// The names of the first `count` values of an enumeration.
template <class Enum, std::size_t count>
std::array<std::string_view, count> names_of() {
  std::array<std::string_view, count> names;
  for (std::size_t i = 0; i < count; ++i) names[i] = name(static_cast<Enum>(i));
  return names;
}

}  // namespace

std::span<const std::string_view> words(Interpolation) {
  static const auto all = names_of<Interpolation, 5>();
  return all;
}

std::span<const std::string_view> words(ShapeInterpolation) {
  static const auto all = names_of<ShapeInterpolation, 3>();
  return all;
}

static std::span<const std::string_view> words(SeawaterEquation) {
  static const auto all = names_of<SeawaterEquation, 3>();
  return all;
}

namespace scenario {
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

constexpr Quantity munk_scale{.noun = "depth", .unit = "m", .low = 10.0, .high = 1e5};
constexpr Quantity latitude_quantity{
    .noun = "latitude", .unit = "degrees north", .low = -90.0, .high = 90.0};

/// Samples of speed over depth.
struct SpeedTable {
  static constexpr std::string_view name = "table";
  Interpolation interpolation = Interpolation::c_linear;
  std::vector<double> depth = {}, speed = {};

  void describe(Fields& field) {
    field("interpolation", interpolation, "how the speed runs between the samples");
    field.columns({{"depth", depth, quantity::water_depth, "of the samples, rising"},
                   {"speed", speed, quantity::sound_speed, "at each depth"}},
                  {.file = true});
  }
};

struct MunkTable {
  static constexpr std::string_view name = "munk";
  MunkParameters munk = {};

  void describe(Fields& field) {
    field("axis_speed", munk.axis_speed, quantity::sound_speed, "on the channel's axis");
    field("axis_depth", munk.axis_depth, quantity::depth, "of the channel's axis");
    field("scale_depth", munk.scale_depth, munk_scale, "of the law");
    field("perturbation", munk.perturbation, {.low = 0.0, .high = 0.1}, "of the law");
  }
};

struct IsovelocityTable {
  static constexpr std::string_view name = "isovelocity";
  double speed = 1500.0;

  void describe(Fields& field) {
    field(required("speed"), speed, quantity::sound_speed, "everywhere");
  }
};

/// What a probe measures: the speed follows by an equation.
struct ProbeTable {
  static constexpr std::string_view name = "temperature-salinity";
  Interpolation interpolation = Interpolation::c_linear;
  SeawaterEquation equation = SeawaterEquation::chen_millero;
  double latitude_deg = 45.0;
  std::vector<double> depth = {}, temperature = {}, salinity = {};

  void describe(Fields& field) {
    field("interpolation", interpolation, "how the speed runs between the levels");
    field("equation", equation, "of sea water");
    field("latitude_deg", latitude_deg, latitude_quantity, "for the pressure at a depth");
    field.columns({{"depth", depth, quantity::depth, "of the levels, rising"},
                   {"temperature", temperature, quantity::temperature, "at each level, in situ"},
                   {"salinity", salinity, quantity::salinity, "at each level"}},
                  {.file = true});
  }
};

/// Speeds on a grid of ranges and depths.
struct SectionTable {
  static constexpr std::string_view name = "section";
  std::string file = {};  ///< a line for every point of the grid, in any order
  std::vector<double> range = {}, depth = {};
  std::vector<std::vector<double>> speed = {};

  void describe(Fields& field) {
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"file"}, false))
      field.file(required("file"), file, "a readable CSV file",
                 "columns range, depth, speed: a line for every point of the grid");
    if (const auto way = field.otherwise(ways, {"range"})) {
      field(required("range"), range, quantity::range, "of the grid's rows, rising");
      field(required("depth"), depth, quantity::water_depth, "within a row, rising");
      field(required("speed"), speed, quantity::sound_speed,
            "of each range a row, with a speed for each depth");
      if (field.checks()) check(field);
    }
  }
  void check(Fields& field) const {
    if (speed.size() != range.size())
      field.fault("speed", "a row for each of the " + std::to_string(range.size()) + " ranges",
                  std::to_string(speed.size()) + " rows");
    if (speed[0].size() != depth.size())
      field.fault("speed[0]",
                  "a speed for each of the " + std::to_string(depth.size()) + " depths");
  }
};

/// [environment.sound_speed]
struct SoundSpeedTable {
  std::variant<SpeedTable, MunkTable, IsovelocityTable, ProbeTable, SectionTable> form = {};

  void describe(Fields& field) {
    field.one_of(required("kind"), form, "how the speed of sound is given");
  }
};

/// The form that has the water's bits.
SoundSpeedTable form_of_water(const Environment& ocean) {
  const auto copied = [](std::span<const double> values) {
    return std::vector<double>(values.begin(), values.end());
  };
  if (ocean.section) {
    SectionTable form{.range = copied(ocean.section->ranges()),
                      .depth = copied(ocean.section->depths())};
    const auto speeds = ocean.section->speeds();
    for (std::size_t i = 0; i < form.range.size(); ++i)
      form.speed.push_back(copied(speeds.subspan(i * form.depth.size(), form.depth.size())));
    return {form};
  }
  if (const auto& munk = ocean.water.munk_parameters()) return {MunkTable{*munk}};
  return {SpeedTable{.interpolation = ocean.water.interpolation(),
                     .depth = copied(ocean.water.depths()),
                     .speed = copied(ocean.water.speeds())}};
}

/// Where a form was read, and the water that it makes.
struct WaterToMake {
  TomlTable& table;
  const OceanReading& reading;
  Environment& ocean;
};

void make_water(const SpeedTable& form, const WaterToMake& to) {
  to.ocean.water = profile_of(to.table, form.depth, form.speed, form.interpolation);
  check_reach(to.table, to.table.has("file") ? "file" : "depth", form.depth, form.speed, to.ocean);
}

void make_water(const MunkTable& form, const WaterToMake& to) {
  to.ocean.water = SoundSpeedProfile::munk(form.munk);
}

void make_water(const IsovelocityTable& form, const WaterToMake& to) {
  to.ocean.water = SoundSpeedProfile::isovelocity(form.speed);
}

SoundSpeedSection grid_of_lists(const SectionTable& form, const TomlTable& table) {
  std::vector<double> speed;
  for (const auto& row : form.speed) speed.insert(speed.end(), row.begin(), row.end());
  try {
    return SoundSpeedSection(form.range, form.depth, speed);
  } catch (const InputError& error) {
    throw table.fault(error.fault().where, error.fault().expected, error.fault().got);
  }
}

SoundSpeedSection grid_of_file(TomlTable& table, const OceanReading& reading) {
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

void make_water(const SectionTable& form, const WaterToMake& to) {
  Environment& ocean = to.ocean;
  ocean.section =
      form.file.empty() ? grid_of_lists(form, to.table) : grid_of_file(to.table, to.reading);
  const auto depth = ocean.section->depths();
  std::vector<double> at_start;
  for (const double z : depth) at_start.push_back(ocean.section->at(0.0, z).c);
  ocean.water = SoundSpeedProfile::table(depth, at_start, Interpolation::c_linear);
  check_reach(to.table, form.file.empty() ? "depth" : "file", depth, ocean.section->speeds(),
              ocean);
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

void make_water(const ProbeTable& form, const WaterToMake& to) {
  const Boundary& bottom = to.ocean.bottom;
  const double bottom_depth = bottom.shape ? bottom.shape->deepest() : bottom.depth;
  note_range(form.equation, form.depth, form.temperature, form.salinity, form.latitude_deg,
             to.reading.notes);
  add_warnings({checks::profile_reach(form.depth.front(), form.depth.back(), to.ocean,
                                      "the water is like that at the first and last")},
               to.reading.notes);
  std::vector<double> depth, speed;
  const auto add = [&](double z, std::size_t level) {
    depth.push_back(z);
    speed.push_back(sound_speed(form.equation, form.temperature[level], form.salinity[level], z,
                                form.latitude_deg));
  };
  // Water above the first and below the last level is like that level, but under its own pressure:
  // levels at most 250 m apart keep the pressure's part of the gradient.
  const std::vector<double>& given = form.depth;
  if (given.front() > 0.0) add(0.0, 0);
  for (std::size_t level = 0; level < given.size(); ++level) add(given[level], level);
  const double rest = std::max(0.0, bottom_depth - given.back());
  const auto extra = static_cast<int>(std::ceil(rest / 250.0));
  for (int i = 1; i <= extra; ++i) add(given.back() + rest * i / extra, given.size() - 1);
  to.ocean.water = profile_of(to.table, depth, speed, form.interpolation);
}

}  // namespace

void read_sound_speed(TomlTable table, const OceanReading& reading, Environment& ocean) {
  KnownSettings known{.folder = reading.folder};
  SoundSpeedTable settings;
  TomlReader reader(table, known);
  settings.describe(reader);
  std::visit([&](const auto& form) { make_water(form, {table, reading, ocean}); }, settings.form);
  table.finish();
}

void describe_sound_speed(Fields& field, const Environment& ocean) {
  SoundSpeedTable settings = form_of_water(ocean);
  field(live("sound_speed"), settings, "of the water");
}

}  // namespace scenario
}  // namespace asdic::detail
