#include "io/scenario/profiles/section.h"

#include <algorithm>

#include "core/quantities.h"
#include "core/text.h"
#include "io/settings/columns.h"

namespace asdic::detail::scenario {
namespace {

void check(Fields& field, const SectionProfile& grid) {
  if (grid.speed.size() != grid.range.size())
    field.fault("speed", "a row for each of the " + std::to_string(grid.range.size()) + " ranges",
                std::to_string(grid.speed.size()) + " rows");
  if (grid.speed[0].size() != grid.depth.size())
    field.fault("speed[0]",
                "a speed for each of the " + std::to_string(grid.depth.size()) + " depths");
}

SoundSpeedSection grid_of_lists(const SectionProfile& form, const TomlTable& table) {
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

}  // namespace

void SectionProfile::describe(Fields& field) {
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"file"}, false))
    field.file(required("file"), file, "a readable CSV file",
               "columns range, depth, speed: a line for every point of the grid");
  if (const auto way = field.otherwise(ways, {"range"})) {
    field(required("range"), range, quantity::range, "of the grid's rows, rising");
    field(required("depth"), depth, quantity::water_depth, "within a row, rising");
    field(required("speed"), speed, quantity::sound_speed,
          "of each range a row, with a speed for each depth");
    if (field.checks()) check(field, *this);
  }
}

void SectionProfile::make(const WaterToMake& to) const {
  Environment& ocean = to.ocean;
  ocean.section =
      file.empty() ? grid_of_lists(*this, to.table) : grid_of_file(to.table, to.reading);
  const auto depths = ocean.section->depths();
  std::vector<double> at_start;
  for (const double z : depths) at_start.push_back(ocean.section->at(0.0, z).c);
  ocean.water = SoundSpeedProfile::table(depths, at_start, Interpolation::c_linear);
  check_reach(to.table, file.empty() ? "depth" : "file", depths, ocean.section->speeds(), ocean);
}

std::optional<SectionProfile> SectionProfile::of(const Environment& ocean) {
  if (!ocean.section) return std::nullopt;
  SectionProfile form{.range = copied(ocean.section->ranges()),
                      .depth = copied(ocean.section->depths())};
  const auto speeds = ocean.section->speeds();
  for (std::size_t i = 0; i < form.range.size(); ++i)
    form.speed.push_back(copied(speeds.subspan(i * form.depth.size(), form.depth.size())));
  return form;
}

}  // namespace asdic::detail::scenario
