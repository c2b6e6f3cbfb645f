#pragma once
#include <cstdint>
#include <vector>

#include "study/measures/cell_counts.h"
#include "study/measures/realisation.h"
#include "study/summary/column_values.h"

namespace asdic::detail::study {

/// Rows of a study, by column; sorted by index.
struct Table {
  std::vector<Column> columns{};
  std::vector<std::uint64_t> index{};  ///< [rows]
  std::vector<std::uint8_t> valid{};   ///< [rows]
  std::vector<ColumnValues> values{};  ///< [columns][rows]
  CellSums cells{};                    ///< of all these rows, where cells are counted
};

}  // namespace asdic::detail::study
