#include "io/climatology/map_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "io/climatology/data_grid.h"
#include "io/climatology/floor.h"
#include "io/climatology/words.h"

namespace asdic::detail {

namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

/// An axis of a file, made to rise; a geographic one that goes round is cut open somewhere else.
struct RisingAxis {
  std::vector<double> places;
  std::vector<std::size_t> index;  // in the file
};

RisingAxis rising(const std::vector<double>& stored) {
  RisingAxis axis{.places = stored};
  for (std::size_t i = 0; i < stored.size(); ++i) axis.index.push_back(i);
  if (stored.size() > 1 && stored.front() > stored.back()) {
    std::reverse(axis.places.begin(), axis.places.end());
    std::reverse(axis.index.begin(), axis.index.end());
  }
  return axis;
}

void cut_open(RisingAxis& axis, double longitude) {
  const double begin = longitude - 180.0;
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t i = 0; i < axis.places.size(); ++i) {
    double x = begin + std::fmod(axis.places[i] - begin, 360.0);
    if (x < begin) x += 360.0;
    all.emplace_back(x, axis.index[i]);
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    axis.places[i] = all[i].first;
    axis.index[i] = all[i].second;
  }
}

/// Reads windows out of a file, with more around them for what is filled.
class WindowReader {
 public:
  WindowReader(std::shared_ptr<const DataGrid> grid, climatology::UnitRule rule, RisingAxis x,
               RisingAxis y, bool volume)
      : grid_(std::move(grid)),
        rule_(std::move(rule)),
        x_(std::move(x)),
        y_(std::move(y)),
        volume_(volume) {}

  void operator()(const MapGrid::Window& window, std::span<float> values) const {
    const std::size_t around = volume_ ? 8 : 0;
    const std::size_t column = window.column - std::min(around, window.column),
                      row = window.row - std::min(around, window.row);
    const std::size_t columns =
        std::min(x_.places.size(), window.column + window.columns + around) - column;
    const std::size_t rows = std::min(y_.places.size(), window.row + window.rows + around) - row;
    const std::size_t levels = std::max<std::size_t>(1, grid_->depths().size());
    std::vector<float> all(columns * rows * levels, no_value);
    // Pieces whose indices run on in the file.
    for (std::size_t begin = 0; begin < columns;) {
      std::size_t end = begin + 1;
      const auto step = [&](std::size_t i) {
        return static_cast<std::ptrdiff_t>(x_.index[column + i]) -
               static_cast<std::ptrdiff_t>(x_.index[column + i - 1]);
      };
      while (end < columns && std::abs(step(end)) == 1) ++end;
      read(column, row, begin, end, rows, columns, levels, all);
      begin = end;
    }
    if (volume_) fill_volume(columns, rows, grid_->depths(), all);
    for (std::size_t j = 0; j < window.rows; ++j) {
      const auto from =
          all.begin() + static_cast<std::ptrdiff_t>(
                            ((window.row - row + j) * columns + window.column - column) * levels);
      std::copy_n(from, window.columns * levels,
                  values.begin() + static_cast<std::ptrdiff_t>(j * window.columns * levels));
    }
  }

 private:
  void read(std::size_t column, std::size_t row, std::size_t begin, std::size_t end,
            std::size_t rows, std::size_t columns, std::size_t levels,
            std::vector<float>& all) const {
    const auto span = [](std::size_t a, std::size_t b) {
      return DataGrid::Indices{std::min(a, b), std::max(a, b)};
    };
    const DataGrid::Block block =
        grid_->block(span(x_.index[column + begin], x_.index[column + end - 1]),
                     span(y_.index[row], y_.index[row + rows - 1]), {0, levels - 1});
    for (std::size_t j = 0; j < rows; ++j)
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t k = 0; k < levels; ++k)
          all[(j * columns + i) * levels + k] =
              static_cast<float>(rule_.scale * block.at(i - begin, j, k) + rule_.offset);
  }

  std::shared_ptr<const DataGrid> grid_;
  climatology::UnitRule rule_;
  RisingAxis x_, y_;
  bool volume_;
};

}  // namespace

OpenedMap open_map(const std::filesystem::path& path, const std::string& variable,
                   const climatology::GriddedQuantity& quantity, double longitude,
                   std::vector<std::string>& notes) {
  const auto file =
      std::make_shared<const DataGrid>(climatology::require_grid({path, variable}, quantity, true));
  const DataGrid& grid = *file;
  if (grid.times() > 1)
    throw InputError(
        {.where = path.string() + ": " + grid.variable(),
         .got = std::to_string(grid.times()) + " times",
         .expected = "one time: asdic ocean --area takes a day or a month out of them"});
  if (&quantity == &climatology::sediment_quantity() && climatology::lower(grid.units()) == "phi")
    throw InputError(
        {.where = path.string() + ": " + grid.variable(),
         .got = "grain sizes in phi",
         .expected = "numbers of classes: asdic ocean --area makes them of grain sizes"});
  climatology::UnitRule rule = climatology::rule_of(grid, quantity, notes);
  OpenedMap opened{.depths = grid.depths(),
                   .geographic = grid.geographic(),
                   .name = path.filename().string() + ": " + grid.variable(),
                   .file = file};
  if (&quantity == &climatology::bathymetry_quantity())
    opened.depth_sign = climatology::depth_sign(grid, notes);
  RisingAxis x = rising(grid.eastings()), y = rising(grid.northings());
  for (const auto* axis : {&x, &y})
    if (axis->places.size() < 2)
      throw InputError({.where = path.string() + ": " + grid.variable(),
                        .got = "an axis of one place",
                        .expected = "a map, of two places along either axis at least"});
  if (grid.geographic() && grid.wraps()) cut_open(x, longitude);
  MapAxis east(grid.geographic() ? "longitude" : "x", x.places),
      north(grid.geographic() ? "latitude" : "y", y.places);
  const std::size_t levels = std::max<std::size_t>(1, grid.depths().size());
  const bool volume = !grid.depths().empty();
  opened.grid = std::make_shared<const MapGrid>(
      std::move(east), std::move(north), levels,
      WindowReader(file, std::move(rule), std::move(x), std::move(y), volume));
  return opened;
}

void fill_volume(std::size_t columns, std::size_t rows, const std::vector<double>& depths,
                 std::span<float> values) {
  constexpr double per_metre = 0.0165;  // of pressure alone [1/s]
  const std::size_t levels = depths.size(), places = columns * rows;
  // Wave by wave from the places that have a value: a place takes the mean of its neighbours' that
  // came before it.
  std::vector<float> next(places);
  for (std::size_t k = 0; k < levels; ++k) {
    const auto value = [&](std::size_t place) -> float& { return values[place * levels + k]; };
    const auto has = [&](std::size_t p) { return !std::isnan(value(p)); };
    bool any = false, all = true;
    for (std::size_t p = 0; p < places; ++p) (has(p) ? any : all) = has(p);
    if (!any || all) continue;
    for (bool more = true; more;) {
      more = false;
      for (std::size_t p = 0; p < places; ++p) {
        next[p] = value(p);
        if (has(p)) continue;
        const std::size_t i = p % columns, j = p / columns;
        double sum = 0.0;
        int count = 0;
        const auto add = [&](std::size_t q) {
          if (has(q)) sum += double(value(q)), ++count;
        };
        if (i > 0) add(p - 1);
        if (i + 1 < columns) add(p + 1);
        if (j > 0) add(p - columns);
        if (j + 1 < rows) add(p + columns);
        if (count > 0) next[p] = static_cast<float>(sum / count), more = true;
      }
      for (std::size_t p = 0; p < places; ++p) value(p) = next[p];
    }
  }
  for (std::size_t p = 0; p < places; ++p)
    for (std::size_t k = 1; k < levels; ++k) {
      float& speed = values[p * levels + k];
      const float above = values[p * levels + k - 1];
      if (std::isnan(speed) && !std::isnan(above))
        speed = above + static_cast<float>(per_metre * (depths[k] - depths[k - 1]));
    }
}

}  // namespace asdic::detail
