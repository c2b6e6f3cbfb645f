// Part of summary_parts.h: sensitivity to the inputs, and convergence.
#include <algorithm>
#include <array>
#include <cmath>

#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

/// First-order index S = Var(E[Y|X])/Var(Y) by groups of rows of like x, the share of the variance
/// between them less what groups of that size have by chance (Kelley's ε²); and √ of the chance's
/// own variance as its error. Saltelli et al., Global Sensitivity Analysis (2008).
struct FirstOrder {
  double index = 0.0, error = 0.0;
};

FirstOrder first_order(const std::vector<double>& x, const std::vector<double>& y,
                       const std::vector<double>& x_ranks) {
  const std::size_t n = y.size();
  const auto groups =
      static_cast<std::size_t>(std::clamp(std::cbrt(static_cast<double>(n)) * 2.0, 2.0, 50.0));
  // Values where there are few, else equally many rows a group, by rank.
  std::vector<double> distinct = x;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  const bool by_value = distinct.size() <= groups;
  const std::size_t k = by_value ? distinct.size() : groups;
  std::vector<Moments> group(k);
  Moments all;
  for (std::size_t i = 0; i < n; ++i) {
    const auto place =
        by_value
            ? static_cast<std::size_t>(std::lower_bound(distinct.begin(), distinct.end(), x[i]) -
                                       distinct.begin())
            : std::min(k - 1, static_cast<std::size_t>((x_ranks[i] - 0.5) / static_cast<double>(n) *
                                                       static_cast<double>(k)));
    group[place].add(y[i]);
    all.add(y[i]);
  }
  const double total = all.deviation() * all.deviation() * (all.count() - 1.0);
  if (!(total > 0.0) || n <= k) return {};
  double between = 0.0;
  for (const Moments& g : group)
    if (g.count() > 0.0) {
      const double d = g.mean() - all.mean();
      between += g.count() * d * d;
    }
  const double share = between / total, count = static_cast<double>(n),
               freedom = static_cast<double>(k - 1);
  return {1.0 - (1.0 - share) * (count - 1.0) / (count - 1.0 - freedom),
          std::sqrt(2.0 * freedom) / (count - 1.0)};
}

}  // namespace

std::vector<SummaryTable> sensitivity_table(const SummaryPlan& plan, const Table& table) {
  SummaryTable made{.name = "sensitivity",
                    .title = "How much each measure depends on each input",
                    .axes = {"measure", "input"}};
  made.columns = {
      {.name = "measure", .unit = "1", .meaning = "column"},
      {.name = "input", .unit = "1", .meaning = "column"},
      {.name = "count", .unit = "1", .meaning = "realisations in which both are finite"},
      {.name = "rank_correlation", .unit = "1", .meaning = "Spearman's; NaN where it has no order"},
      {.name = "rank_correlation_low", .unit = "1", .meaning = "confidence interval"},
      {.name = "rank_correlation_high", .unit = "1", .meaning = "confidence interval"},
      {.name = "first_order", .unit = "1", .meaning = "share of the variance due to it alone"},
      {.name = "first_order_error",
       .unit = "1",
       .meaning = "standard deviation of an input without effect"}};
  made.values.resize(made.columns.size());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].role == Column::Role::measure)
      made.columns[0].labels.push_back(table.columns[c].name);
    if (table.columns[c].role == Column::Role::input)
      made.columns[1].labels.push_back(table.columns[c].name);
  }
  const double z = two_sided(plan.confidence), none = std::nan("");
  double measure = -1.0;
  for (std::size_t m = 0; m < table.columns.size(); ++m) {
    if (table.columns[m].role != Column::Role::measure) continue;
    measure += 1.0;
    double input = -1.0;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (table.columns[i].role != Column::Role::input) continue;
      input += 1.0;
      std::vector<double> x, y;
      for (std::size_t row = 0; row < table.index.size(); ++row)
        if (counts(table, row, m) && counts(table, row, i)) {
          x.push_back(table.values[i][row]);
          y.push_back(table.values[m][row]);
        }
      const auto n = static_cast<double>(x.size());
      std::vector<double> row{measure, input, n, none, none, none, none, none};
      if (x.size() >= 4) {
        const std::vector<double> rank = ranks(x);
        if (table.columns[i].labels.empty()) {
          // Fisher's transformation; 1.06/(n − 3) is the variance for ranks (Fieller et al. 1957).
          const double r = correlation(rank, ranks(y));
          const double f = std::atanh(std::clamp(r, -1.0 + 1e-15, 1.0 - 1e-15));
          const double half = z * std::sqrt(1.06 / (n - 3.0));
          row[3] = r;
          row[4] = std::tanh(f - half);
          row[5] = std::tanh(f + half);
        }
        const FirstOrder index = first_order(x, y, rank);
        row[6] = index.index;
        row[7] = index.error;
      }
      for (std::size_t k = 0; k < row.size(); ++k) made.values[k].push_back(row[k]);
    }
  }
  if (made.values[0].empty()) return {};
  return {made};
}

std::vector<SummaryTable> convergence_table(const SummaryPlan& plan, const Table& table) {
  const std::optional<std::size_t> question = first_question(table.columns);
  if (!question) return {};
  const Column& column = table.columns[*question];
  const bool proportion = is_proportion(column);
  const std::string name = proportion ? proportion_name(column) : column.name;
  SummaryTable made{.name = "convergence",
                    .title = name + " after ever more realisations, in order of their index",
                    .axes = {"count"}};
  made.columns = {{.name = "count", .unit = "1", .meaning = "valid realisations"},
                  {.name = name, .unit = column.unit, .meaning = "estimate"},
                  {.name = name + "_low", .unit = column.unit, .meaning = "confidence interval"},
                  {.name = name + "_high", .unit = column.unit, .meaning = "confidence interval"}};
  made.values.resize(made.columns.size());
  std::size_t total = 0;
  for (std::size_t row = 0; row < table.index.size(); ++row) total += counts(table, row, *question);
  Moments moments;
  double next = 2.0;  // twenty points a decade, and the last
  for (std::size_t row = 0; row < table.index.size(); ++row) {
    if (!counts(table, row, *question)) continue;
    moments.add(table.values[*question][row]);
    if (moments.count() < next && moments.count() < static_cast<double>(total)) continue;
    next = std::max(moments.count() + 1.0, moments.count() * std::pow(10.0, 0.05));
    Interval interval = moments.mean_interval(plan.confidence);
    if (proportion)
      interval = proportion_interval(plan.interval, std::round(moments.mean() * moments.count()),
                                     moments.count(), plan.confidence);
    const std::array<double, 4> values{moments.count(), moments.mean(), interval.low,
                                       interval.high};
    for (std::size_t k = 0; k < values.size(); ++k) made.values[k].push_back(values[k]);
  }
  return {made};
}

}  // namespace asdic::detail::study
