#pragma once
#include <span>
#include <vector>

#include "study/plan/study.h"
#include "study/summary/table.h"

// Measures that are formulae of what a row holds: [summary.own]. Rows hold nothing of them, so they
// may change without another run. docs/formats/study.md
namespace asdic::detail::study {

[[nodiscard]] std::vector<Column> own_columns(const Study& study);
/// The columns of the rows, and behind them its own.
[[nodiscard]] std::vector<Column> answer_columns(const Study& study);

/// Computes them.
class OwnValues {
 public:
  OwnValues() = default;
  explicit OwnValues(const Study& study);

  [[nodiscard]] bool empty() const noexcept { return formulae_.empty(); }
  /// Makes the values of a row those of answer_columns(): what tells how it was made, behind the
  /// columns of the rows, goes. \param valid  else they are not numbers
  void append(std::vector<double>& values, bool valid) const;
  /// Of whole tables: its own columns and their values; nothing of the rows' own.
  [[nodiscard]] Table of(const Table& rows) const;

 private:
  std::size_t columns_ = 0;  // of the rows
  std::vector<OwnFormula> formulae_;
  std::vector<Column> own_;
};

/// The rows with its own columns.
[[nodiscard]] Table with_own(const Study& study, Table rows);

}  // namespace asdic::detail::study
