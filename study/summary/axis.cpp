#include "study/summary/axis.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

constexpr std::size_t few_values = 20;    // of an axis whose values are bins of their own …
constexpr std::size_t rows_a_value = 10;  // … or if there are so many rows to each
constexpr int default_bins = 10;

std::vector<double> edges_of(const SummaryAxis& asked, const std::vector<double>& sorted,
                             const Span& ends) {
  if (!asked.edges.empty()) return asked.edges;
  if (sorted.empty()) return {};
  const double low = std::isfinite(ends.low) ? std::min(ends.low, sorted.front()) : sorted.front();
  const double high = std::isfinite(ends.high) ? std::max(ends.high, sorted.back()) : sorted.back();
  std::vector<double> edges;
  const int bins = asked.bins > 0 ? asked.bins : default_bins;
  for (int i = 0; i <= bins; ++i) {
    const double share = static_cast<double>(i) / bins;
    edges.push_back(asked.equal_count ? sample_quantile(sorted, share)
                                      : std::lerp(low, high, share));
  }
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  if (edges.size() < 2) edges.push_back(edges.front());
  return edges;
}

}  // namespace

std::size_t column_of(const Table& table, const std::string& name) {
  const auto it = std::find_if(table.columns.begin(), table.columns.end(),
                               [&](const Column& column) { return column.name == name; });
  return static_cast<std::size_t>(it - table.columns.begin());
}

AxisBins make_axis(const SummaryAxis& asked, const Table& table, const Span& ends) {
  AxisBins axis{.column = column_of(table, asked.column)};
  std::vector<double> sorted;
  sorted.reserve(table.index.size());
  for (std::size_t row = 0; row < table.index.size(); ++row)
    if (counts(table, row, axis.column)) sorted.push_back(table.values[axis.column][row]);
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> distinct;
  std::unique_copy(sorted.begin(), sorted.end(), std::back_inserter(distinct));
  const bool few = distinct.size() <= few_values || distinct.size() * rows_a_value <= sorted.size();
  const bool bins = !asked.edges.empty() || asked.bins > 0 || asked.equal_count;
  axis.by_value = !table.columns[axis.column].labels.empty() || (few && !bins);
  axis.edges = axis.by_value ? distinct : edges_of(asked, sorted, ends);
  sorted = std::vector<double>();  // {} would keep its memory
  distinct = std::vector<double>();
  axis.bin.reserve(table.index.size());
  for (std::size_t row = 0; row < table.index.size(); ++row) {
    int bin = -1;
    if (counts(table, row, axis.column)) {
      const double x = table.values[axis.column][row];
      const auto it = std::upper_bound(axis.edges.begin(), axis.edges.end(), x);
      bin = static_cast<int>(it - axis.edges.begin()) - 1;
      if (!axis.by_value && x == axis.edges.back()) --bin;  // the last bin is closed
      if (bin >= static_cast<int>(axis.bins())) bin = -1;
    }
    axis.bin.push_back(bin);
  }
  table.values[axis.column].rest();
  return axis;
}

Cells::Cells(std::vector<AxisBins> axes, const Table& table) : axes_(std::move(axes)) {
  std::size_t cells = 1;
  for (const AxisBins& axis : axes_) {
    cells *= axis.bins();
    columns_.push_back(table.columns[axis.column]);
  }
  rows_.resize(cells);
  for (std::size_t row = 0; row < table.index.size(); ++row) {
    std::size_t cell = 0;
    bool inside = true;
    for (const AxisBins& axis : axes_) {
      inside = inside && axis.bin[row] >= 0;
      if (inside) cell = cell * axis.bins() + static_cast<std::size_t>(axis.bin[row]);
    }
    if (inside) rows_[cell].push_back(row);
  }
}

bool Cells::is_along(std::size_t column) const noexcept {
  return std::any_of(axes_.begin(), axes_.end(),
                     [&](const AxisBins& axis) { return axis.column == column; });
}

SummaryTable Cells::table(const std::string& name, const std::string& title) const {
  SummaryTable made{.name = name, .title = title};
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const Column& column = columns_[a];
    add_column(made, column, column.name, axes_[a].by_value ? "value" : "middle of the bin");
    made.axes.push_back(column.name);
    if (axes_[a].by_value) continue;
    add_column(made, column, column.name + "_low", "least of the bin");
    add_column(made, column, column.name + "_high", "greatest of the bin");
    made.edges.insert(made.edges.end(), {column.name + "_low", column.name + "_high"});
  }
  add_column(made, {.unit = "1"}, "count", "valid realisations");
  return made;
}

void Cells::start_row(SummaryTable& to, std::size_t cell, double count) const {
  std::vector<std::size_t> bins(axes_.size());
  for (std::size_t a = axes_.size(); a-- > 0; cell /= axes_[a].bins())
    bins[a] = cell % axes_[a].bins();
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const double low = axes_[a].low(bins[a]), high = axes_[a].high(bins[a]);
    if (axes_[a].by_value)
      put(to, {low});
    else
      put(to, {0.5 * (low + high), low, high});
  }
  put(to, {count});
}

void add_column(SummaryTable& to, const Column& like, const std::string& name,
                const std::string& meaning) {
  Column column{.name = name, .unit = like.unit, .meaning = meaning, .labels = like.labels};
  to.columns.push_back(std::move(column));
  to.values.emplace_back();
}

void put(SummaryTable& to, std::initializer_list<double> row) {
  auto column = std::find_if(to.values.begin(), to.values.end(), [&](const auto& values) {
    return values.size() < to.values.front().size();
  });
  if (column == to.values.end()) column = to.values.begin();  // a new row
  for (const double x : row) (column++)->push_back(x);
}

}  // namespace asdic::detail::study
