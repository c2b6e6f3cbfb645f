#pragma once
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "study/plan/summary_plan.h"
#include "study/sampling/law.h"
#include "study/summary/summary.h"

namespace asdic::detail::study {

/// How the rows of a table fall along one of its columns: into bins, or value by value.
struct AxisBins {
  std::size_t column = 0;  ///< of the table
  bool by_value = false;
  std::vector<double> edges;  ///< [bins + 1]; by value: the values [bins]
  std::vector<int> bin;       ///< [rows] −1: in none
  [[nodiscard]] std::size_t bins() const { return by_value ? edges.size() : edges.size() - 1; }
  [[nodiscard]] double low(std::size_t i) const { return edges[i]; }
  [[nodiscard]] double high(std::size_t i) const { return edges[by_value ? i : i + 1]; }
};

/// \param ends  of the law of the axis' input: as long as a study goes on, and in every study of
/// that law, its bins are the same   \return without edges where no row counts
[[nodiscard]] AxisBins make_axis(const SummaryAxis& asked, const Table& table, const Span& ends);

/// The rows of a table by the cells that axes make, the last axis fastest.
class Cells {
 public:
  /// \param axes  at least one, with edges
  Cells(std::vector<AxisBins> axes, const Table& table);

  [[nodiscard]] std::size_t size() const noexcept { return rows_.size(); }
  [[nodiscard]] const std::vector<std::size_t>& rows(std::size_t cell) const { return rows_[cell]; }
  [[nodiscard]] bool is_along(std::size_t column) const noexcept;  ///< one of the axes
  /// With the columns that say which cell a row is, and their count.
  [[nodiscard]] SummaryTable table(const std::string& name, const std::string& title) const;
  /// A row's values of these columns. \param count  of the realisations in it
  void start_row(SummaryTable& to, std::size_t cell, double count) const;

 private:
  std::vector<AxisBins> axes_;
  std::vector<Column> columns_;                 // [axes]
  std::vector<std::vector<std::size_t>> rows_;  // [cells] of the table
};

/// A column more. \param like  whose unit and labels it has
void add_column(SummaryTable& to, const Column& like, const std::string& name,
                const std::string& meaning);
/// The values of a row that it has not so far, in the columns' order.
void put(SummaryTable& to, std::initializer_list<double> row);

/// The column of a name; as many as there are: there is none.
[[nodiscard]] std::size_t column_of(const Table& table, const std::string& name);

}  // namespace asdic::detail::study
