// Part of summary_parts.h: proportions and means along axes.
#include <algorithm>
#include <cmath>
#include <set>

#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

constexpr std::size_t few_values = 20;    // of an axis whose values are bins of their own …
constexpr std::size_t rows_a_value = 10;  // … or if there are so many rows to each
constexpr int default_bins = 10;

std::size_t column_of(const Table& table, const std::string& name) {
  const auto it = std::find_if(table.columns.begin(), table.columns.end(),
                               [&](const Column& column) { return column.name == name; });
  return static_cast<std::size_t>(it - table.columns.begin());
}

/// How the rows fall along one axis.
struct Axis {
  std::size_t column = 0;
  bool by_value = false;
  std::vector<double> edges;  ///< [bins + 1]; by value: the values [bins]
  std::vector<int> bin;       ///< [rows] −1: in none
  [[nodiscard]] std::size_t bins() const { return by_value ? edges.size() : edges.size() - 1; }
  [[nodiscard]] double low(std::size_t i) const { return edges[i]; }
  [[nodiscard]] double high(std::size_t i) const { return edges[by_value ? i : i + 1]; }
};

/// \param ends  of the law of the axis' input: as long as a study goes on, and in every study of
/// that law, its bins are the same
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

Axis make_axis(const SummaryAxis& asked, const Table& table, const Span& ends) {
  Axis axis{.column = column_of(table, asked.column)};
  std::vector<double> sorted;
  for (std::size_t row = 0; row < table.index.size(); ++row)
    if (counts(table, row, axis.column)) sorted.push_back(table.values[axis.column][row]);
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> distinct;
  std::unique_copy(sorted.begin(), sorted.end(), std::back_inserter(distinct));
  const bool few = distinct.size() <= few_values || distinct.size() * rows_a_value <= sorted.size();
  const bool bins = !asked.edges.empty() || asked.bins > 0 || asked.equal_count;
  axis.by_value = !table.columns[axis.column].labels.empty() || (few && !bins);
  axis.edges = axis.by_value ? distinct : edges_of(asked, sorted, ends);
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
  return axis;
}

void add(SummaryTable& to, const Column& like, const std::string& name,
         const std::string& meaning) {
  Column column{.name = name, .unit = like.unit, .meaning = meaning, .labels = like.labels};
  to.columns.push_back(std::move(column));
  to.values.emplace_back();
}

void put(SummaryTable& to, std::initializer_list<double> row, std::size_t& at) {
  for (const double x : row) to.values[at++].push_back(x);
}

/// The columns that say which bin a row of the table is.
SummaryTable start(const std::string& name, const std::string& title, const std::vector<Axis>& axes,
                   const Table& table) {
  SummaryTable made{.name = name, .title = title};
  for (const Axis& axis : axes) {
    const Column& column = table.columns[axis.column];
    add(made, column, column.name, axis.by_value ? "value" : "middle of the bin");
    made.axes.push_back(column.name);
    if (axis.by_value) continue;
    add(made, column, column.name + "_low", "least of the bin");
    add(made, column, column.name + "_high", "greatest of the bin");
    made.edges.insert(made.edges.end(), {column.name + "_low", column.name + "_high"});
  }
  add(made, {.unit = "1"}, "count", "valid realisations");
  return made;
}

/// The false alarms beside a target's detections, by the matched filter.
std::optional<std::size_t> alarms_of(const Study& study, const Table& table,
                                     const Column& detected) {
  const std::string head = "detected";
  if (!study.measure.detection || !detected.name.starts_with(head)) return std::nullopt;
  const std::size_t column = column_of(table, "false_alarm" + detected.name.substr(head.size()));
  return column < table.columns.size() ? std::optional(column) : std::nullopt;
}

}  // namespace

std::vector<SummaryTable> tables_by(const Study& study, const std::vector<SummaryAxis>& asked,
                                    const Table& table) {
  const SummaryPlan& plan = study.summary;
  std::vector<Axis> axes;
  std::string suffix, along;
  for (const SummaryAxis& axis : asked) {
    axes.push_back(make_axis(axis, table, ends_of(study.variables, axis.column)));
    if (axes.back().edges.empty()) return {};  // no valid row
    suffix += (axes.size() > 1 ? "_and_" : "_by_") + axis.column;
    along += (axes.size() > 1 ? " and " : " against ") + axis.column;
  }
  // Rows by cell, the last axis fastest.
  std::size_t cells = 1;
  for (const Axis& axis : axes) cells *= axis.bins();
  std::vector<std::vector<std::size_t>> rows(cells);
  for (std::size_t row = 0; row < table.index.size(); ++row) {
    std::size_t cell = 0;
    bool inside = true;
    for (const Axis& axis : axes) {
      inside = inside && axis.bin[row] >= 0;
      if (inside) cell = cell * axis.bins() + static_cast<std::size_t>(axis.bin[row]);
    }
    if (inside) rows[cell].push_back(row);
  }
  const auto put_cell = [&](SummaryTable& to, std::size_t cell, double count) {
    std::size_t at = 0, rest = cell;
    std::vector<std::size_t> bins(axes.size());
    for (std::size_t a = axes.size(); a-- > 0; rest /= axes[a].bins())
      bins[a] = rest % axes[a].bins();
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const double low = axes[a].low(bins[a]), high = axes[a].high(bins[a]);
      if (axes[a].by_value)
        put(to, {low}, at);
      else
        put(to, {0.5 * (low + high), low, high}, at);
    }
    put(to, {count}, at);
    return at;
  };

  std::vector<SummaryTable> all;
  std::vector<std::size_t> others;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    if (column.role != Column::Role::measure) continue;
    if (!is_proportion(column)) {
      const bool along_itself =
          std::any_of(axes.begin(), axes.end(), [&](const Axis& axis) { return axis.column == c; });
      if (!along_itself) others.push_back(c);
      continue;
    }
    const std::string name = proportion_name(column);
    SummaryTable made = start(name + suffix, column.meaning + along, axes, table);
    const Column probability{.unit = "1"};
    add(made, probability, "hits", "realisations in which it happened");
    add(made, probability, name, column.meaning + ": share of the realisations");
    add(made, probability, name + "_low", "confidence interval");
    add(made, probability, name + "_high", "confidence interval");
    const std::optional<std::size_t> alarms = alarms_of(study, table, column);
    if (alarms) {
      add(made, probability, "pfa_count", "realisations whose false alarms are known");
      add(made, probability, "pfa", "false-alarm rate that was found");
      add(made, probability, "pfa_low", "confidence interval (Clopper & Pearson)");
      add(made, probability, "pfa_high", "confidence interval (Clopper & Pearson)");
      add(made, probability, "pfa_set", "false-alarm probability that is set");
    }
    for (std::size_t cell = 0; cell < cells; ++cell) {
      double count = 0.0, hits = 0.0;
      for (const std::size_t row : rows[cell])
        if (counts(table, row, c)) {
          count += 1.0;
          hits += table.values[c][row];
        }
      std::size_t at = put_cell(made, cell, count);
      const Interval interval = proportion_interval(plan.interval, hits, count, plan.confidence);
      put(made, {hits, hits / count, interval.low, interval.high}, at);
      if (!alarms) continue;
      double known = 0.0, rang = 0.0;
      for (const std::size_t row : rows[cell])
        if (counts(table, row, *alarms)) {
          known += 1.0;
          rang += table.values[*alarms][row];
        }
      const Interval found = clopper_pearson(rang, known, plan.confidence);
      put(made,
          {known, rang / known, found.low, found.high, study.measure.false_alarm_probability()},
          at);
    }
    all.push_back(std::move(made));
  }
  if (others.empty()) return all;
  SummaryTable made = start("means" + suffix, "Means" + along, axes, table);
  for (const std::size_t c : others) {
    const Column& column = table.columns[c];
    add(made, column, column.name, "mean: " + column.meaning);
    add(made, column, column.name + "_low", "confidence interval of the mean");
    add(made, column, column.name + "_high", "confidence interval of the mean");
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const auto valid = std::count_if(rows[cell].begin(), rows[cell].end(),
                                     [&](std::size_t row) { return table.valid[row] != 0; });
    std::size_t at = put_cell(made, cell, static_cast<double>(valid));
    for (const std::size_t c : others) {
      Moments moments;
      for (const std::size_t row : rows[cell])
        if (counts(table, row, c)) moments.add(table.values[c][row]);
      const Interval interval = moments.mean_interval(plan.confidence);
      put(made, {moments.mean(), interval.low, interval.high}, at);
    }
  }
  all.push_back(std::move(made));
  return all;
}

}  // namespace asdic::detail::study
