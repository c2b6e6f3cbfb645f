#include "study/summary/summary.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/text.h"
#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {

bool is_proportion(const Column& column) noexcept {
  const auto is = [&](std::string_view name) {
    return column.name == name || column.name.starts_with(std::string(name) + '_');
  };
  return column.role == Column::Role::measure && (is("detected") || is("false_alarm"));
}

std::string proportion_name(const Column& column) {
  const std::string_view word = column.name.starts_with("detected") ? "detected" : "false_alarm";
  return (word == "detected" ? "pd" : "pfa") + column.name.substr(word.size());
}

std::optional<std::size_t> first_question(std::span<const Column> columns) noexcept {
  std::optional<std::size_t> first;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (is_proportion(columns[c])) return c;
    if (columns[c].role == Column::Role::measure && !first) first = c;
  }
  return first;
}

std::string quantile_name(double probability) {
  std::array<char, 400> fixed{};
  const auto end = std::to_chars(fixed.data(), fixed.data() + fixed.size(), probability,
                                 std::chars_format::fixed)
                       .ptr;
  std::string digits(fixed.data(), end);
  std::erase(digits, '.');
  return "q" + digits + std::string(4 - std::min<std::size_t>(4, digits.size()), '0');
}

bool counts(const Table& table, std::size_t row, std::size_t column) noexcept {
  return table.valid[row] != 0 && std::isfinite(table.values[column][row]);
}

SummaryTable statistics_table(const SummaryPlan& plan, const Table& table) {
  SummaryTable made{.name = "statistics",
                    .title = "Every column over all valid realisations, in its own unit",
                    .axes = {"quantity"}};
  const auto column = [&](const std::string& name, const std::string& unit,
                          const std::string& meaning) {
    made.columns.push_back({.name = name, .unit = unit, .meaning = meaning});
    made.values.emplace_back();
  };
  const std::string of;  // as many units as rows: none
  column("quantity", "1", "column of the rows");
  column("count", "1", "finite values");
  column("mean", of, "mean");
  column("deviation", of, "standard deviation");
  column("mean_low", of, "confidence interval of the mean");
  column("mean_high", of, "confidence interval of the mean");
  column("least", of, "least value");
  column("greatest", of, "greatest value");
  for (const double p : plan.quantiles) {
    column(quantile_name(p), of, "quantile at " + to_text(p));
  }
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    Moments moments;
    std::vector<double> sorted;
    for (std::size_t row = 0; row < table.index.size(); ++row)
      if (counts(table, row, c)) {
        moments.add(table.values[c][row]);
        sorted.push_back(table.values[c][row]);
      }
    std::sort(sorted.begin(), sorted.end());
    const double none = std::nan("");
    Interval interval = moments.mean_interval(plan.confidence);
    if (is_proportion(table.columns[c]))
      interval = proportion_interval(plan.interval, std::round(moments.mean() * moments.count()),
                                     moments.count(), plan.confidence);
    made.columns[0].labels.push_back(table.columns[c].name);
    std::vector<double> row{static_cast<double>(c),
                            moments.count(),
                            moments.mean(),
                            moments.deviation(),
                            interval.low,
                            interval.high,
                            sorted.empty() ? none : sorted.front(),
                            sorted.empty() ? none : sorted.back()};
    for (const double p : plan.quantiles)
      row.push_back(sorted.empty() ? none : sample_quantile(sorted, p));
    for (std::size_t i = 0; i < row.size(); ++i) made.values[i].push_back(row[i]);
  }
  return made;
}

std::vector<SummaryTable> summarise(const Study& study, const Table& table) {
  const SummaryPlan& plan = study.summary;
  std::vector<SummaryTable> all{statistics_table(plan, table)};
  const auto add = [&](std::vector<SummaryTable> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
  };
  for (const std::vector<SummaryAxis>& axes : plan.by) add(tables_by(study, axes, table));
  if (plan.roc) add(roc_tables(plan, table));
  if (plan.convergence) add(convergence_table(plan, table));
  if (plan.sensitivity) add(sensitivity_table(plan, table));
  return all;
}

Summary summary_of(const Study& study, const Table& table) {
  const SummaryPlan& plan = study.summary;
  std::string intervals = "as of independent draws";
  if (study.design != Design::random)
    intervals += ": of this design, " + std::string(name(study.design)) +
                 ", rather too wide than too narrow (docs/theory/studies.md)";
  return {.tables = summarise(study, table),
          .confidence = plan.confidence,
          .proportion_interval =
              plan.interval == ProportionInterval::wilson ? "wilson" : "clopper_pearson",
          .intervals = std::move(intervals)};
}

}  // namespace asdic::detail::study
