#pragma once
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "study/summary/summary.h"
#include "study/summary/weighted_mean.h"

namespace asdic::detail::study {

class Cells;

// The tables of a summary, one function each. docs/theory/studies.md

/// A measure that is 0 or 1, whose mean is a probability.
[[nodiscard]] bool is_proportion(const Column& column) noexcept;
/// "pd" of "detected", "pfa" of "false_alarm", "ptrack" of "initiated", "ptracked" of "tracked",
/// with a target's suffix; "p_loud" of one's own "loud".
[[nodiscard]] std::string proportion_name(const Column& column);
/// The column that the study is about: the first proportion, else the first measure. None: no
/// measures.
[[nodiscard]] std::optional<std::size_t> first_question(std::span<const Column> columns) noexcept;

/// "q0500" of 0.5, "q09999" of 0.9999: the probability's digits without its point, at least three
/// behind it.
[[nodiscard]] std::string quantile_name(double probability);

/// \throws InputError where two columns of the rows, two tables of [summary], or two columns of one
/// of these would have one name; names the entry of `by` that brings the second. \param study whole
/// but for its rows
void check_summary_names(const Study& study);

/// Whether a row counts for a column: valid, and finite there.
[[nodiscard]] bool counts(const Table& table, std::size_t row, std::size_t column) noexcept;

/// Weights of rows that were drawn from a proposal; empty: they have none.
[[nodiscard]] std::vector<double> weights_of(const Table& table);
/// Whether its rows have weights.
[[nodiscard]] bool is_weighted(const Table& table) noexcept;

/// Means of a table's columns, by the rows' weights where they have some.
class RowMeans {
 public:
  RowMeans(const Study& study, const Table& table);

  [[nodiscard]] bool weighted() const noexcept { return !weights_.empty(); }
  [[nodiscard]] double weight(std::size_t row) const noexcept {
    return weighted() ? weights_[row] : 1.0;
  }
  /// Of rows in a cell, whose probability is not known. \param rows  increasing
  [[nodiscard]] RowMean in_cell(std::span<const std::size_t> rows, std::size_t column) const;
  /// Of all rows. \param value  of a row, not finite: not known
  template <class Value>
  [[nodiscard]] RowMean of_all(Value value) const {
    RowMean mean(clusters_, weighted(), WeightedMean::Of::all_rows);
    for (std::size_t row = 0; row < table_.index.size(); ++row)
      if (const double x = value(row); std::isfinite(x))
        mean.add(table_.index[row], x, weight(row));
      else
        mean.leave_out(table_.index[row], weight(row));
    return mean;
  }
  /// The same of a column.
  [[nodiscard]] RowMean of_column(std::size_t column) const;

 private:
  const Table& table_;
  Clusters clusters_;
  std::vector<double> weights_;  // [rows]; empty: none
};

/// What the rows of a probability are worth, behind its other columns: "effective" and
/// "largest_share". \param head  before their names: "pd_"
void add_worth(SummaryTable& to, const std::string& head = "");
void put_worth(SummaryTable& to, const RowMean& mean);

/// How many rows each part of the proposal has, and what they give to the first question.
[[nodiscard]] std::vector<SummaryTable> drawn_from_table(const Study& study, const Table& table);
/// What is to be known of a probability that weights estimate: rows of the event that are too few,
/// or one that has much of it. A sentence each.
[[nodiscard]] std::vector<std::string> weight_warnings(const Study& study, const Table& table);

/// Count, mean, deviation, interval of the mean, extremes and quantiles of every column.
[[nodiscard]] SummaryTable statistics_table(const Study& study, const Table& table);
/// Proportions and means of all measures along one axis or over two: "pd_by_range", …,
/// "means_by_range".
[[nodiscard]] std::vector<SummaryTable> tables_by(const Study& study,
                                                  const std::vector<SummaryAxis>& axes,
                                                  const Table& table);
/// Ellipses of the errors of place in these cells, where localisation_ellipse is measured:
/// "ellipses_by_range", and along and across the line of sight "sight_ellipses_by_range".
[[nodiscard]] std::vector<SummaryTable> ellipse_tables(const Study& study, const Cells& cells,
                                                       const std::string& suffix,
                                                       const std::string& along,
                                                       const Table& table);
/// Of a run of pings, for each target: probabilities against the number of the ping ("pings"), and
/// when it is detected first ("first_detection").
[[nodiscard]] std::vector<SummaryTable> ping_tables(const Study& study, const Table& table);
/// Of [summary.map], for each cell of place and depth: proportions ("map_pd"), and means and
/// quantiles of all other measures ("map_means").
[[nodiscard]] std::vector<SummaryTable> map_tables(const Study& study, const Table& table);
/// Receiver operating characteristic of each target's matched filter, and the area under it.
[[nodiscard]] std::vector<SummaryTable> roc_tables(const SummaryPlan& plan, const Table& table);
/// Of the cells without an echo: rates by time, at every power of ten by counting or by a tail that
/// is fitted, and the operating characteristic that they reach to.
[[nodiscard]] std::vector<SummaryTable> cell_tables(const Study& study, const Table& table);
/// Warnings of a receiver that makes significantly more false alarms than even noise does.
[[nodiscard]] std::vector<std::string> alarm_warnings(const Study& study, const Table& table);
/// Where the false-alarm rates of these tables cannot be the one that is set, within a factor of
/// 1.3: a sentence each.
[[nodiscard]] std::vector<std::string> rate_warnings(const Study& study,
                                                     const std::vector<SummaryTable>& tables);
/// The first question's estimate after ever more rows.
[[nodiscard]] std::vector<SummaryTable> convergence_table(const Study& study, const Table& table);
/// How much every measure depends on every input.
[[nodiscard]] std::vector<SummaryTable> sensitivity_table(const Study& study, const Table& table);
/// The same of Saltelli's design, whose blocks tell total orders and pairs: "sensitivity" and
/// "interactions".
[[nodiscard]] std::vector<SummaryTable> saltelli_tables(const Study& study, const Table& table);
/// Of Saltelli's design the rows that are independent of one another, A and B of every block.
[[nodiscard]] Table independent_rows(const Study& study, const Table& table);

/// "range 12500, wind_speed 3.5": where a row of a table lies along its axes.
[[nodiscard]] std::string place_in(const SummaryTable& table, std::size_t row);

/// Spearman's rank correlation and its interval, by Fisher's transformation.
struct RankCorrelation {
  double value = 0.0, low = 0.0, high = 0.0;
};
/// \param x_ranks  at least four
[[nodiscard]] RankCorrelation rank_correlation(std::span<const double> x_ranks,
                                               std::span<const double> y, double confidence);

}  // namespace asdic::detail::study
