// Part of case_parts.h: the grids of BELLHOP3D, .bty, .ati and .ssp.
#include <cmath>

#include "core/quantities.h"
#include "io/bellhop/case_parts.h"
#include "io/bellhop/decimal.h"
#include "io/bellhop/grid_file.h"

namespace asdic::detail::bellhop {
namespace {

constexpr double least_step = 0.1;                  // of an axis [m]
constexpr std::int64_t most_grid_places = 100'000;  // of an axis
constexpr std::int64_t most_grid_values =
    50'000'000;  // memory is taken as rows are read, not before

/// A count and a vector: all values, or its two ends. \param unit  of the file   \return × factor
std::vector<double> read_grid_axis(ListReader& file, const std::string& name, const char* unit,
                                   double factor) {
  file.begin("number of " + name);
  const std::int64_t n = file.need_integer("", 2, most_grid_places);
  file.end();
  const GivenVector given = read_vector(file, n, name);
  if (!given.left.empty())
    file.fail("", shown(given.left) + " after " + std::to_string(n) + " numbers",
              "as many as the line above says");
  std::vector<double> axis = given.values;
  if (given.are_ends()) {
    axis.clear();
    for (std::int64_t i = 0; i < n; ++i)
      axis.push_back(std::lerp(given.values[0], given.values[1], double(i) / double(n - 1)));
  }
  axis.resize(std::size_t(n), axis.front());
  for (std::size_t i = 1; i < axis.size(); ++i) {
    const std::string item = "value " + std::to_string(i + 1), before = shown(axis[i - 1]) + unit;
    if (!(axis[i] > axis[i - 1]))
      file.fail(item, shown(axis[i]) + unit, "above the one before, " + before);
    if (factor * (axis[i] - axis[i - 1]) < least_step)
      file.fail(item, shown(axis[i]) + unit,
                "at least " + shown(least_step) + " m above the one before, " + before);
  }
  for (double& value : axis) value *= factor;
  return axis;
}

void check_grid_size(const ListReader& file, double values) {
  if (values > double(most_grid_values))
    file.fail("", shown(values) + " values", "at most " + shown(double(most_grid_values)));
}

/// How many numbers stand on the lines of a file's rows.
struct LinesOfRows {
  bool alike = true;       ///< every line has as many as the first
  std::size_t on_one = 0;  ///< numbers on the first line
  bool broken = false;     ///< a row goes over several lines

  void add(std::size_t numbers) {
    if (on_one == 0) on_one = numbers;
    alike = alike && numbers == on_one;
  }
};

std::string expected_rows(const GridFile& grid) {
  return "a row for each of the " + std::to_string(grid.y.size()) +
         " y, with a number for each of the " + std::to_string(grid.x.size()) + " x";
}

/// A value for every x, on lines of its own: numbers left over are not dropped.
void read_row(ListReader& file, GridFile& grid, bool volume, LinesOfRows& lines) {
  std::size_t on_line = 0, line = 0;
  for (std::size_t i = 0; i < grid.x.size(); ++i) {
    grid.values.push_back(file.need_real(volume ? "speed" : "depth"));
    if (volume && !quantity::sound_speed.holds(grid.values.back()))
      file.fail("speed", shown(grid.values.back()) + " m/s", quantity::sound_speed.expected());
    if (i > 0 && file.line() != line) {
      lines.broken = true;
      lines.add(on_line);
      on_line = 0;
    }
    line = file.line();
    ++on_line;
  }
  lines.add(on_line);
  if (const std::string left = file.number_left(); !left.empty())
    file.fail("", shown(left) + " after " + std::to_string(grid.x.size()) + " numbers",
              expected_rows(grid));
}

/// \throws InputError  every line has a number for each y: it is a row for each x that stands there
void check_not_turned(const ListReader& file, const GridFile& grid, const LinesOfRows& lines) {
  if (!lines.broken || !lines.alike || lines.on_one != grid.y.size()) return;
  throw InputError({.where = file.file(),
                    .got = "lines of " + std::to_string(lines.on_one) + " numbers, as many as y",
                    .expected = expected_rows(grid)});
}

std::string grid_axis_text(const std::vector<double>& axis, double factor) {
  std::string text = std::to_string(axis.size()) + '\n';
  for (std::size_t i = 0; i < axis.size(); ++i)
    text += decimal_read_as(axis[i], axis[i] / factor, [&](double x) { return factor * x; }) +
            (i + 1 == axis.size() ? '\n' : ' ');
  return text;
}

}  // namespace

GridFile read_grid_file(ListReader file, bool volume) {
  GridFile grid;
  if (!volume) {
    file.begin("type");
    std::string type;
    if (!file.text(type, "")) file.fail("", "no value", "R or C in quotes");
    type.resize(std::max<std::size_t>(type.size(), 2), ' ');
    if (type[0] != 'R' && type[0] != 'C')
      file.fail("letter 1", shown(type.substr(0, 1)),
                "R (facets) or C (curvilinear): the case is over a map");
    if (type[1] != ' ' && type[1] != 'S')
      file.fail("letter 2", shown(type.substr(1, 1)),
                "a blank or S (depths alone): materials over a map are not read");
    file.end();
    grid.curvilinear = type[0] == 'C';
  }
  grid.x = read_grid_axis(file, "x", " km", 1000.0);
  grid.y = read_grid_axis(file, "y", " km", 1000.0);
  check_grid_size(file, double(grid.x.size()) * double(grid.y.size()));
  if (volume) grid.z = read_grid_axis(file, "levels", " m", 1.0);
  const std::size_t levels = volume ? grid.z.size() : 1;
  check_grid_size(file, double(grid.x.size()) * double(grid.y.size()) * double(levels));
  LinesOfRows lines;
  for (std::size_t k = 0; k < levels; ++k)
    for (const double y : grid.y) {
      const std::string at_y = "y = " + shown(y / 1000.0) + " km";
      file.begin(volume ? "speeds at " + shown(grid.z[k]) + " m, " + at_y : "depths at " + at_y);
      read_row(file, grid, volume, lines);
      file.end();
    }
  check_not_turned(file, grid, lines);
  if (!file.at_end()) {
    file.begin("end");
    std::string rest;
    file.text(rest, "");
    file.fail("", shown(rest),
              "nothing after the last of " + std::to_string(levels) + " times " +
                  std::to_string(grid.y.size()) + " rows, one for each y");
  }
  return grid;
}

std::string grid_file_text(const GridFile& grid) {
  const bool volume = !grid.z.empty();
  std::string text;
  if (!volume) text = grid.curvilinear ? "'C'\n" : "'R'\n";
  text += grid_axis_text(grid.x, 1000.0) + grid_axis_text(grid.y, 1000.0);
  if (volume) text += grid_axis_text(grid.z, 1.0);
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    text += decimal(grid.values[i]) + ((i + 1) % grid.x.size() == 0 ? '\n' : ' ');
  return text;
}

}  // namespace asdic::detail::bellhop
