// Part of summary_parts.h: proportions and means along axes.
#include <algorithm>
#include <utility>

#include "study/summary/axis.h"
#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

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
  const Clusters clusters = clusters_of(study);
  std::vector<AxisBins> axes;
  std::string suffix, along;
  for (const SummaryAxis& axis : asked) {
    axes.push_back(make_axis(axis, table, ends_of(study.variables, axis.column)));
    if (axes.back().edges.empty()) return {};  // no valid row
    suffix += (axes.size() > 1 ? "_and_" : "_by_") + axis.column;
    along += (axes.size() > 1 ? " and " : " against ") + axis.column;
  }
  const Cells cells(std::move(axes), table);

  std::vector<SummaryTable> all;
  std::vector<std::size_t> others;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    if (column.role != Column::Role::measure) continue;
    if (!is_proportion(column)) {
      if (!cells.is_along(c)) others.push_back(c);
      continue;
    }
    const std::string name = proportion_name(column);
    SummaryTable made = cells.table(name + suffix, column.meaning + along);
    const Column probability{.unit = "1"};
    add_column(made, probability, "hits", "realisations in which it happened");
    add_column(made, probability, name, column.meaning + ": share of the realisations");
    add_column(made, probability, name + "_low", "confidence interval");
    add_column(made, probability, name + "_high", "confidence interval");
    const std::optional<std::size_t> alarms = alarms_of(study, table, column);
    if (alarms) {
      add_column(made, probability, "pfa_count", "realisations whose false alarms are known");
      add_column(made, probability, "pfa", "false-alarm rate that was found");
      add_column(made, probability, "pfa_low", "confidence interval (Clopper & Pearson)");
      add_column(made, probability, "pfa_high", "confidence interval (Clopper & Pearson)");
      add_column(made, probability, "pfa_set", "false-alarm probability that is set");
    }
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      double hits = 0.0;
      ClusteredMean share(clusters);
      for (const std::size_t row : cells.rows(cell))
        if (counts(table, row, c)) {
          share.add(table.index[row], table.values[c][row]);
          hits += table.values[c][row];
        }
      cells.start_row(made, cell, share.count());
      const Interval interval = share.proportion(plan.interval, plan.confidence);
      put(made, {hits, hits / share.count(), interval.low, interval.high});
      if (!alarms) continue;
      double known = 0.0, rang = 0.0;
      for (const std::size_t row : cells.rows(cell))
        if (counts(table, row, *alarms)) {
          known += 1.0;
          rang += table.values[*alarms][row];
        }
      const Interval found = clopper_pearson(rang, known, plan.confidence);
      put(made,
          {known, rang / known, found.low, found.high, study.measure.false_alarm_probability()});
    }
    all.push_back(std::move(made));
    table.values[c].rest();
    if (alarms) table.values[*alarms].rest();
  }
  if (others.empty()) return all;
  SummaryTable made = cells.table("means" + suffix, "Means" + along);
  for (const std::size_t c : others) {
    const Column& column = table.columns[c];
    add_column(made, column, column.name, "mean: " + column.meaning);
    add_column(made, column, column.name + "_low", "confidence interval of the mean");
    add_column(made, column, column.name + "_high", "confidence interval of the mean");
  }
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const auto valid = std::count_if(cells.rows(cell).begin(), cells.rows(cell).end(),
                                     [&](std::size_t row) { return table.valid[row] != 0; });
    cells.start_row(made, cell, static_cast<double>(valid));
    for (const std::size_t c : others) {
      ClusteredMean moments(clusters);
      for (const std::size_t row : cells.rows(cell))
        if (counts(table, row, c)) moments.add(table.index[row], table.values[c][row]);
      table.values[c].rest();
      const Interval interval = moments.mean_interval(plan.confidence);
      put(made, {moments.mean(), interval.low, interval.high});
    }
  }
  all.push_back(std::move(made));
  return all;
}

}  // namespace asdic::detail::study
