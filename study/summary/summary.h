#pragma once
#include <optional>
#include <string>
#include <vector>

#include "study/measures/cell_counts.h"
#include "study/measures/realisation.h"
#include "study/summary/law_tables.h"
#include "study/summary/own_columns.h"
#include "study/summary/weighted_mean.h"

namespace asdic::detail::study {

/// A table of the summary: columns of equal length ("pd_by_range": centre, count, pd, low, high).
struct SummaryTable {
  std::string name, title;
  std::vector<Column> columns;
  std::vector<std::vector<double>> values;  ///< [columns][rows]
  std::vector<std::string> axes{};   ///< columns that tell which row it is: of one, its coordinate
  std::vector<std::string> edges{};  ///< columns with the ends of the bins along them
  std::string intervals{};           ///< by which method its intervals are had; "": it has none
};

/// All that [summary] asks for, out of the rows alone: the same bits for the same rows.
[[nodiscard]] std::vector<SummaryTable> summarise(const Study& study, const Table& table);

/// The tables, and what their intervals are.
struct Summary {
  std::vector<SummaryTable> tables{};
  double confidence = 0.95;                    ///< of all intervals
  std::string proportion_interval = "wilson";  ///< or "clopper_pearson"
  std::string intervals{};                     ///< what they suppose, in a sentence
  std::vector<LawTable> laws{};                ///< of the inputs; they are not of the rows
  std::vector<std::string> notes{};            ///< what the user should know of the answers
  std::vector<std::string> warnings{};         ///< of what was found, a sentence each
  std::string left_out{};                      ///< which tables are not made, and why
  std::vector<RowDensity> densities{};         ///< of inputs whose laws have formulae
  Table own{};                                 ///< the columns of [summary.own] alone
};
[[nodiscard]] Summary summary_of(const Study& study, const Table& table);

/// The running answer to the study's first question (Pd, or the mean of the first measure).
struct Estimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;  ///< with its confidence interval
  double level = 0.95;
  std::uint64_t count = 0;  ///< valid rows behind it
};
/// Accumulates rows one by one, in order of their index. Copyable; of constant memory.
class RunningEstimate {
 public:
  explicit RunningEstimate(const Study& study);
  void add(const Row& row);
  /// The same, where the values of its answer_columns() are known.
  void take(const Row& row, const std::vector<double>& values);
  [[nodiscard]] std::optional<Estimate> estimate() const;  ///< none before two valid rows
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const Clusters& clusters() const noexcept { return mean_.clusters(); }
  /// Valid rows in which the answer is not known or not finite: they do not count.
  [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }
  /// Reason why the answer is not known in the first of these rows; "": none was given.
  [[nodiscard]] const std::string& unknown() const noexcept { return unknown_; }

 private:
  std::string name_, unit_, unknown_;
  std::size_t column_ = 0, weight_ = 0;
  bool proportion_ = false;
  ProportionInterval interval_ = ProportionInterval::wilson;
  double level_ = 0.95;
  std::uint64_t left_out_ = 0;
  RowMean mean_;
  OwnValues own_;
};

}  // namespace asdic::detail::study
