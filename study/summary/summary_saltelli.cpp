// Part of summary_parts.h: sensitivity by the blocks of Saltelli's design.
#include <algorithm>
#include <cmath>

#include "study/plan/no_value.h"
#include "study/summary/saltelli.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

/// The column of a group that has one alone, whose values have an order.
std::optional<std::size_t> single_column(const Study& study, const Table& table,
                                         const SaltelliGroup& group) {
  if (group.variables.size() != 1) return std::nullopt;
  const std::vector<InputColumn> columns = input_columns(study.variables[group.variables.front()]);
  if (columns.size() != 1 || !columns.front().labels.empty()) return std::nullopt;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == columns.front().name) return c;
  return std::nullopt;
}

void put_row(SummaryTable& to, const std::vector<double>& row) {
  for (std::size_t k = 0; k < row.size(); ++k) to.values[k].push_back(row[k]);
}

}  // namespace

Table independent_rows(const Study& study, const Table& table) {
  const std::size_t rows = saltelli_blocks(study).rows();
  Table kept{.columns = table.columns};
  kept.values.resize(table.values.size());
  for (std::size_t row = 0; row < table.index.size(); ++row) {
    if (table.index[row] % rows > SaltelliBlocks::b) continue;
    kept.index.push_back(table.index[row]);
    kept.valid.push_back(table.valid[row]);
    for (std::size_t c = 0; c < table.values.size(); ++c)
      kept.values[c].push_back(table.values[c][row]);
  }
  return kept;
}

std::vector<SummaryTable> saltelli_tables(const Study& study, const Table& table) {
  const SummaryPlan& plan = study.summary;
  const SaltelliBlocks blocks = saltelli_blocks(study);
  const std::vector<SaltelliGroup> all_groups = saltelli_groups(study);
  std::vector<std::string> groups;
  groups.reserve(all_groups.size());
  for (const SaltelliGroup& group : all_groups) groups.push_back(group.name);
  const BlockValues::Places places(table.index, blocks.rows());
  const Table independent = independent_rows(study, table);
  std::vector<std::string> measures;
  for (const Column& column : table.columns)
    if (column.role == Column::Role::measure) measures.push_back(column.name);
  if (measures.empty() || groups.empty()) return {};

  const std::string interval = "confidence interval";
  SummaryTable made{
      .name = "sensitivity",
      .title = "How much each measure depends on each input: by itself, and with all others",
      .columns = {{.name = "measure", .unit = "1", .meaning = "column", .labels = measures},
                  {.name = "input",
                   .unit = "1",
                   .meaning = "entry of [vary], or group of them, all columns together; chance: "
                              "what a realisation draws beside",
                   .labels = groups},
                  {.name = "count", .unit = "1", .meaning = "blocks in which all is known"},
                  {.name = "left_out", .unit = "1", .meaning = "blocks in which it is not"},
                  {.name = "rank_correlation",
                   .unit = "1",
                   .meaning = "Spearman's, of rows A and B; NaN where it has no order"},
                  {.name = "rank_correlation_low", .unit = "1", .meaning = interval},
                  {.name = "rank_correlation_high", .unit = "1", .meaning = interval},
                  {.name = "first_order",
                   .unit = "1",
                   .meaning = "share of the variance due to it alone"},
                  {.name = "first_order_error", .unit = "1", .meaning = "standard error"},
                  {.name = "first_order_low", .unit = "1", .meaning = interval},
                  {.name = "first_order_high", .unit = "1", .meaning = interval},
                  {.name = "total_order",
                   .unit = "1",
                   .meaning = "share of the variance due to it, alone and with others"},
                  {.name = "total_order_low", .unit = "1", .meaning = interval},
                  {.name = "total_order_high", .unit = "1", .meaning = interval},
                  {.name = "unexplained",
                   .unit = "1",
                   .meaning = "share of the measure's variance that is of no input by itself: "
                              "interactions and chance"},
                  {.name = "unexplained_low", .unit = "1", .meaning = interval},
                  {.name = "unexplained_high", .unit = "1", .meaning = interval}},
      .axes = {"measure", "input"},
      .intervals =
          "Fieller's, of ratios of means over independent blocks, Student's t; total "
          "orders of proportions not narrower than those of how often rows differ"};
  made.values.resize(made.columns.size());
  SummaryTable pairs{
      .name = "interactions",
      .title = "How much of each measure's variance two inputs make together, beyond each alone",
      .columns = {{.name = "measure", .unit = "1", .meaning = "column", .labels = measures},
                  {.name = "input", .unit = "1", .meaning = "entry of [vary]", .labels = groups},
                  {.name = "with", .unit = "1", .meaning = "another one", .labels = groups},
                  {.name = "count", .unit = "1", .meaning = "blocks in which all is known"},
                  {.name = "second_order", .unit = "1", .meaning = "share of the variance"},
                  {.name = "second_order_low", .unit = "1", .meaning = interval},
                  {.name = "second_order_high", .unit = "1", .meaning = interval}},
      .axes = {"measure", "input", "with"},
      .intervals = "Fieller's, of ratios of means over independent blocks, Student's t"};
  pairs.values.resize(pairs.columns.size());

  double measure = 0.0;
  for (std::size_t m = 0; m < table.columns.size(); ++m) {
    if (table.columns[m].role != Column::Role::measure) continue;
    const bool proportion = is_proportion(table.columns[m]);
    const BlockValues values(places, table.values[m].span(), table.valid);
    const Index left = unexplained_share(blocks, values, plan.confidence);
    for (std::size_t i = 0; i < groups.size(); ++i) {
      const Index first = first_order_index(blocks, values, i, plan.confidence);
      const Index total =
          total_order_index(blocks, values, i, proportion, plan.interval, plan.confidence);
      RankCorrelation rank{no_value, no_value, no_value};
      if (const std::optional<std::size_t> c = single_column(study, table, all_groups[i])) {
        std::vector<double> x, y;
        for (std::size_t row = 0; row < independent.index.size(); ++row)
          if (counts(independent, row, m) && counts(independent, row, *c)) {
            x.push_back(independent.values[*c][row]);
            y.push_back(independent.values[m][row]);
          }
        independent.values[*c].rest();
        if (x.size() >= 4) rank = rank_correlation(ranks(x), y, plan.confidence);
      }
      put_row(made, {measure, static_cast<double>(i), first.blocks,
                     static_cast<double>(values.size()) - first.blocks, rank.value, rank.low,
                     rank.high, first.value, first.error, first.interval.low, first.interval.high,
                     total.value, total.interval.low, total.interval.high, left.value,
                     left.interval.low, left.interval.high});
      for (std::size_t j = i + 1; blocks.second_order() && j < groups.size(); ++j) {
        const Index second = second_order_index(blocks, values, i, j, plan.confidence);
        put_row(pairs, {measure, static_cast<double>(i), static_cast<double>(j), second.blocks,
                        second.value, second.interval.low, second.interval.high});
      }
    }
    measure += 1.0;
    table.values[m].rest();
  }
  std::vector<SummaryTable> all{std::move(made)};
  if (!pairs.values[0].empty()) all.push_back(std::move(pairs));
  return all;
}

}  // namespace asdic::detail::study
