// Part of summary_parts.h: maps of place.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/text.h"
#include "core/units.h"
#include "study/plan/no_value.h"
#include "study/summary/axis.h"
#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

/// East and north of what has this range and this true bearing.
struct Place {
  double east = 0.0, north = 0.0;
};
Place place_of(double range, double bearing_deg) {
  const double bearing = radians(bearing_deg);
  return {.east = range * std::sin(bearing), .north = range * std::cos(bearing)};
}

/// Ends of east and north between those of the laws of range and bearing; not finite without them.
std::array<Span, 2> ends_of_place(const Span& range, const Span& bearing) {
  const bool known = std::isfinite(range.low) && std::isfinite(range.high) &&
                     std::isfinite(bearing.low) && std::isfinite(bearing.high);
  if (!known) {
    const Span none{.low = -infinity, .high = infinity};
    return {none, none};
  }
  Span east{.low = infinity, .high = -infinity}, north = east;
  const auto reach = [&](double deg) {
    for (const double r : {range.low, range.high}) {
      const Place at = place_of(r, deg);
      // What a rounded sine leaves of 0 is no place.
      const auto whole = [&](double x) { return std::abs(x) < 1e-9 * range.high ? 0.0 : x; };
      east = {.low = std::min(east.low, whole(at.east)),
              .high = std::max(east.high, whole(at.east))};
      north = {.low = std::min(north.low, whole(at.north)),
               .high = std::max(north.high, whole(at.north))};
    }
  };
  reach(bearing.low);
  reach(bearing.high);
  for (double quarter = 90.0 * std::ceil(bearing.low / 90.0); quarter <= bearing.high;
       quarter += 90.0)
    reach(quarter);
  return {east, north};
}

/// The columns that a map's cells are made of: depth (if any), then across, then up.
Table places_of(const SummaryMap& map, const Table& table) {
  Table made{.columns = {}, .index = table.index, .valid = table.valid, .values = {}};
  const auto take = [&](const std::string& name) {
    const std::size_t column = column_of(table, name);
    made.columns.push_back(table.columns[column]);
    made.values.push_back(table.values[column]);
  };
  if (map.depth) take(map.depth->column);
  if (map.range.empty()) {
    take(map.across.column);
    take(map.up.column);
    return made;
  }
  const ColumnValues& range = table.values[column_of(table, map.range)];
  const ColumnValues& bearing = table.values[column_of(table, map.bearing)];
  std::vector<double> east, north;
  for (std::size_t row = 0; row < range.size(); ++row) {
    const Place at = place_of(range[row], bearing[row]);
    east.push_back(at.east);
    north.push_back(at.north);
  }
  made.columns.push_back({.name = "east", .unit = "m", .role = Column::Role::input});
  made.columns.push_back({.name = "north", .unit = "m", .role = Column::Role::input});
  made.values.push_back(std::move(east));
  made.values.push_back(std::move(north));
  return made;
}

/// Ten cells where nothing is said: places are seldom few values.
SummaryAxis in_bins(SummaryAxis axis) {
  constexpr int usual = 10;
  if (axis.edges.empty() && axis.bins == 0) axis.bins = usual;
  return axis;
}

/// Quantiles of values that may be −∞: straight between the order statistics, or by their weights.
class Quantiles {
 public:
  explicit Quantiles(bool weighted) : weighted_(weighted) {}
  void add(double x, double weight) {
    if (weighted_)
      with_weights_.emplace_back(x, weight);
    else
      values_.push_back(x);
  }
  void sort() {
    std::sort(values_.begin(), values_.end());
    std::sort(with_weights_.begin(), with_weights_.end());
  }
  /// Once they are sorted; NaN of none.
  [[nodiscard]] double at(double p) const {
    if (weighted_) return weighted_quantile(with_weights_, p);
    if (values_.empty()) return no_value;
    const double x = sample_quantile(values_, p);
    if (std::isfinite(x)) return x;
    return values_[static_cast<std::size_t>(p * static_cast<double>(values_.size() - 1))];
  }

 private:
  bool weighted_;
  std::vector<double> values_;
  std::vector<std::pair<double, double>> with_weights_;
};

class Map {
 public:
  Map(const Study& study, const Table& table)
      : study_(study), table_(table), row_means_(study, table) {}

  [[nodiscard]] std::vector<SummaryTable> tables() const {
    const SummaryMap& map = *study_.summary.map;
    const Table places = places_of(map, table_);
    std::vector<AxisBins> axes;
    if (map.depth)
      axes.push_back(make_axis(*map.depth, places, ends_of(study_.variables, map.depth->column)));
    std::array<Span, 2> ends{ends_of(study_.variables, map.across.column),
                             ends_of(study_.variables, map.up.column)};
    if (!map.range.empty())
      ends = ends_of_place(ends_of(study_.variables, map.range),
                           ends_of(study_.variables, map.bearing));
    axes.push_back(make_axis(in_bins(map.across), places, ends[0]));
    axes.push_back(make_axis(in_bins(map.up), places, ends[1]));
    for (const AxisBins& axis : axes)
      if (axis.edges.empty()) return {};  // no valid row
    const Cells cells(std::move(axes), places);
    std::vector<SummaryTable> all;
    std::vector<std::size_t> others;
    for (std::size_t c = 0; c < table_.columns.size(); ++c) {
      const Column& column = table_.columns[c];
      const bool along =
          std::any_of(places.columns.begin(), places.columns.end(),
                      [&](const Column& place) { return place.name == column.name; });
      if (column.role != Column::Role::measure || along) continue;
      if (is_proportion(column))
        all.push_back(proportion(cells, c));
      else
        others.push_back(c);
    }
    if (!others.empty()) all.push_back(means(cells, others));
    return all;
  }

 private:
  [[nodiscard]] SummaryTable proportion(const Cells& cells, std::size_t c) const {
    const Column& column = table_.columns[c];
    const std::string name = proportion_name(column);
    SummaryTable made = cells.table("map_" + name, column.meaning + ", over place");
    const Column share{.unit = "1"};
    add_column(made, share, "hits", "realisations in which it happened");
    add_column(made, share, name, column.meaning + ": share of the realisations");
    add_column(made, share, name + "_low", "confidence interval");
    add_column(made, share, name + "_high", "confidence interval");
    if (row_means_.weighted()) add_worth(made);
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      double hits = 0.0;
      for (const std::size_t row : cells.rows(cell))
        if (counts(table_, row, c)) hits += table_.values[c][row];
      const RowMean mean = row_means_.in_cell(cells.rows(cell), c);
      cells.start_row(made, cell, mean.count());
      const Interval interval = interval_of(mean, true);
      put(made, {hits, row_means_.weighted() ? mean.value(true) : hits / mean.count(), interval.low,
                 interval.high});
      if (row_means_.weighted()) put_worth(made, mean);
    }
    return made;
  }

  [[nodiscard]] Interval interval_of(const RowMean& mean, bool proportion) const {
    return mean.interval(proportion, study_.summary.interval, study_.summary.confidence);
  }

  /// Means are of finite values, quantiles of all that is known, −∞ too.
  [[nodiscard]] SummaryTable means(const Cells& cells,
                                   const std::vector<std::size_t>& columns) const {
    const std::vector<double>& quantiles = study_.summary.quantiles;
    SummaryTable made = cells.table("map_means", "Means and quantiles over place");
    for (const std::size_t c : columns) {
      const Column& column = table_.columns[c];
      add_column(made, column, column.name, "mean of what is finite: " + column.meaning);
      add_column(made, column, column.name + "_low", "confidence interval of the mean");
      add_column(made, column, column.name + "_high", "confidence interval of the mean");
      add_column(made, {.unit = "1"}, column.name + "_count", "realisations that the mean is of");
      for (const double p : quantiles)
        add_column(made, column, column.name + '_' + quantile_name(p),
                   "quantile at " + to_text(p) + " of what is known, −∞ too");
    }
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const auto valid = std::count_if(cells.rows(cell).begin(), cells.rows(cell).end(),
                                       [&](std::size_t row) { return table_.valid[row] != 0; });
      cells.start_row(made, cell, static_cast<double>(valid));
      for (const std::size_t c : columns) {
        const RowMean mean = row_means_.in_cell(cells.rows(cell), c);
        Quantiles known(row_means_.weighted());
        for (const std::size_t row : cells.rows(cell)) {
          const double x = table_.values[c][row];
          if (table_.valid[row] != 0 && !std::isnan(x)) known.add(x, row_means_.weight(row));
        }
        known.sort();
        const Interval interval = interval_of(mean, false);
        put(made, {mean.count() > 0.0 ? mean.value(false) : no_value, interval.low, interval.high,
                   mean.count()});
        for (const double p : quantiles) put(made, {known.at(p)});
      }
    }
    return made;
  }

  const Study& study_;
  const Table& table_;
  RowMeans row_means_;
};

}  // namespace

std::vector<SummaryTable> map_tables(const Study& study, const Table& table) {
  if (!study.summary.map) return {};
  return Map(study, table).tables();
}

}  // namespace asdic::detail::study
