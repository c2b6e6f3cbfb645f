// Part of summary_parts.h: sensitivity to the inputs, and convergence.
#include <algorithm>
#include <array>
#include <cmath>

#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"
#include "study/summary/weighted_mean.h"

namespace asdic::detail::study {
namespace {

/// First-order index S = Var(E[Y|X])/Var(Y) by groups of rows of like x, the share of the variance
/// between them less what groups of that size have by chance (Kelley's ε²); and √ of the chance's
/// own variance as its error. Saltelli et al., Global Sensitivity Analysis (2008).
struct FirstOrder {
  double index = 0.0, error = 0.0;
  double deviation = 0.0;  ///< of the estimate: by linearisation in the rows, and chance's error
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
  std::vector<std::size_t> place(n);
  Moments all;
  for (std::size_t i = 0; i < n; ++i) {
    place[i] =
        by_value
            ? static_cast<std::size_t>(std::lower_bound(distinct.begin(), distinct.end(), x[i]) -
                                       distinct.begin())
            : std::min(k - 1, static_cast<std::size_t>((x_ranks[i] - 0.5) / static_cast<double>(n) *
                                                       static_cast<double>(k)));
    group[place[i]].add(y[i]);
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
  // η² = B/T, so a row moves it by 2(y − m)(m − μ) + (m − μ)² − η²(y − μ)², over T; m its group's.
  Moments influence;
  for (std::size_t i = 0; i < n; ++i) {
    const double m = group[place[i]].mean(), d = m - all.mean(), e = y[i] - all.mean();
    influence.add(2.0 * (y[i] - m) * d + d * d - share * e * e);
  }
  const double error = std::sqrt(2.0 * freedom) / (count - 1.0);
  const double moved = influence.deviation() * std::sqrt(count) / total;
  return {1.0 - (1.0 - share) * (count - 1.0) / (count - 1.0 - freedom), error,
          std::hypot(moved, error)};
}

/// Which entry of [vary] each input is of: columns of one law tell of the same.
std::vector<std::size_t> entries_of(const Study& study, const std::vector<std::string>& inputs) {
  std::vector<std::size_t> entries;
  for (const std::string& name : inputs) {
    std::size_t entry = study.variables.size() + entries.size();  // none: by itself
    for (std::size_t v = 0; v < study.variables.size(); ++v)
      for (const InputColumn& column : input_columns(study.variables[v]))
        if (column.name == name) entry = v;
    entries.push_back(entry);
  }
  return entries;
}

/// Whether the columns of an entry are one choice, and so tell the same: they must not be summed.
bool is_choice(const Study& study, std::size_t entry) {
  return entry < study.variables.size() && choices_of(study.variables[entry]) > 0;
}

/// 1 − Σ of the first-order indices; of the columns of one choice the largest.
double unexplained(const Study& study, const std::vector<std::size_t>& entries,
                   std::span<const double> first) {
  double left = 1.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    double share = first[i];
    if (is_choice(study, entries[i])) {
      bool is_first = true;
      for (std::size_t k = 0; k < first.size(); ++k)
        if (entries[k] == entries[i]) {
          share = std::max(share, first[k]);
          is_first = is_first && k >= i;
        }
      if (!is_first) continue;
    }
    left -= share;
  }
  return left;
}

}  // namespace

RankCorrelation rank_correlation(std::span<const double> x_ranks, std::span<const double> y,
                                 double confidence) {
  // Fisher's transformation; 1.06/(n − 3) is the variance for ranks (Fieller et al. 1957).
  const double r = correlation(x_ranks, ranks(y));
  const double f = std::atanh(std::clamp(r, -1.0 + 1e-15, 1.0 - 1e-15));
  const double half =
      two_sided(confidence) * std::sqrt(1.06 / (static_cast<double>(y.size()) - 3.0));
  return {r, std::tanh(f - half), std::tanh(f + half)};
}

std::vector<SummaryTable> sensitivity_table(const Study& study, const Table& table) {
  const SummaryPlan& plan = study.summary;
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
       .meaning = "standard deviation of an input without effect"},
      {.name = "first_order_low", .unit = "1", .meaning = "confidence interval"},
      {.name = "first_order_high", .unit = "1", .meaning = "confidence interval"},
      {.name = "unexplained",
       .unit = "1",
       .meaning = "share of the measure's variance that is of no input by itself: interactions and "
                  "chance"}};
  made.intervals =
      "first order by the normal distribution and linearisation in the rows, rank correlations by "
      "Fisher's transformation, of " +
      std::string(study.design == Design::random ? "independent rows"
                                                 : "rows taken for independent");
  made.values.resize(made.columns.size());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].role == Column::Role::measure)
      made.columns[0].labels.push_back(table.columns[c].name);
    if (table.columns[c].role == Column::Role::input)
      made.columns[1].labels.push_back(table.columns[c].name);
  }
  const std::vector<std::size_t> entries = entries_of(study, made.columns[1].labels);
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
      std::vector<double> row{measure, input, n, none, none, none, none, none, none, none, none};
      if (x.size() >= 4) {
        const std::vector<double> rank = ranks(x);
        if (table.columns[i].labels.empty()) {
          const RankCorrelation r = rank_correlation(rank, y, plan.confidence);
          row[3] = r.value;
          row[4] = r.low;
          row[5] = r.high;
        }
        const FirstOrder index = first_order(x, y, rank);
        row[6] = index.index;
        row[7] = index.error;
        row[8] = index.index - z * index.deviation;
        row[9] = index.index + z * index.deviation;
      }
      for (std::size_t k = 0; k < row.size(); ++k) made.values[k].push_back(row[k]);
    }
    const std::size_t count = entries.size(), end = made.values[6].size();
    const auto errors = std::span(made.values[7]).subspan(end - count);
    const bool varies = std::any_of(errors.begin(), errors.end(), [](double e) { return e > 0.0; });
    const double left =
        varies ? unexplained(study, entries, std::span(made.values[6]).subspan(end - count)) : none;
    std::fill(made.values[10].end() - static_cast<std::ptrdiff_t>(count), made.values[10].end(),
              left);
  }
  if (made.values[0].empty()) return {};
  return {made};
}

std::vector<SummaryTable> convergence_table(const Study& study, const Table& table) {
  const SummaryPlan& plan = study.summary;
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
  const std::vector<double> weights = weights_of(table);
  RowMean moments(clusters_of(study), !weights.empty(), WeightedMean::Of::all_rows);
  double next = 2.0;  // twenty points a decade, and the last
  for (std::size_t row = 0; row < table.index.size(); ++row) {
    const double weight = weights.empty() ? 1.0 : weights[row];
    if (!counts(table, row, *question)) {
      moments.leave_out(table.index[row], weight);
      continue;
    }
    moments.add(table.index[row], table.values[*question][row], weight);
    if (moments.count() < next && moments.count() < static_cast<double>(total)) continue;
    next = std::max(moments.count() + 1.0, moments.count() * std::pow(10.0, 0.05));
    const Interval interval = moments.interval(proportion, plan.interval, plan.confidence);
    const std::array<double, 4> values{moments.count(), moments.value(proportion), interval.low,
                                       interval.high};
    for (std::size_t k = 0; k < values.size(); ++k) made.values[k].push_back(values[k]);
  }
  return {made};
}

}  // namespace asdic::detail::study
