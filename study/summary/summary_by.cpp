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
  std::vector<AxisBins> axes;
  std::string suffix, along;
  for (const SummaryAxis& axis : asked) {
    axes.push_back(make_axis(axis, table, ends_of(study.variables, axis.column)));
    if (axes.back().edges.empty()) return {};  // no valid row
    suffix += (axes.size() > 1 ? "_and_" : "_by_") + axis.column;
    along += (axes.size() > 1 ? " and " : " against ") + axis.column;
  }
  const Cells cells(std::move(axes), table);
  const RowMeans means(study, table);
  const bool weighted = means.weighted();
  const auto mean_of = [&](std::size_t cell, std::size_t column) {
    return means.in_cell(cells.rows(cell), column);
  };

  std::vector<SummaryTable> all = ellipse_tables(study, cells, suffix, along, table);
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
    if (weighted) add_worth(made);
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      double hits = 0.0;
      for (const std::size_t row : cells.rows(cell))
        if (counts(table, row, c)) hits += table.values[c][row];
      const RowMean share = mean_of(cell, c);
      cells.start_row(made, cell, share.count());
      const Interval interval = share.interval(true, plan.interval, plan.confidence);
      put(made,
          {hits, weighted ? share.value(true) : hits / share.count(), interval.low, interval.high});
      if (alarms && weighted) {
        const RowMean rate = mean_of(cell, *alarms);
        const Interval found = rate.interval(true, plan.interval, plan.confidence);
        put(made, {rate.count(), rate.value(true), found.low, found.high,
                   study.measure.false_alarm_probability()});
      } else if (alarms) {
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
      if (weighted) put_worth(made, share);
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
      const RowMean moments = mean_of(cell, c);
      table.values[c].rest();
      const Interval interval = moments.interval(false, plan.interval, plan.confidence);
      put(made, {moments.value(false), interval.low, interval.high});
    }
  }
  all.push_back(std::move(made));
  return all;
}

}  // namespace asdic::detail::study
