#pragma once
#include <string>
#include <vector>

#include "io/hdf5/scale.h"

namespace asdic::detail {

/// A table of a ping file: a group of 1-D columns that grow together, with an index as the scale of
/// their dimension.
class GrowingTable {
 public:
  struct Column {
    std::string name, long_name, units;  ///< no units: a count or a number
    ElementType type = ElementType::float64;
    Meaning meaning{};
  };

  GrowingTable(Hdf5File& file, const std::string& group, const std::string& dimension,
               std::vector<Column> columns);

  /// Adds one row in the order of the columns; NaN for a missing number.
  void row(const std::vector<double>& values);
  /// Writes the rows added since the last time.
  void write();
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }

 private:
  Hdf5File* file_;
  std::string group_, dimension_;
  std::vector<Column> columns_;
  std::vector<std::vector<double>> pending_;
  std::size_t rows_ = 0, written_ = 0;
};

}  // namespace asdic::detail
