#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/text/csv_table.h"
#include "io/text/toml_table.h"

namespace asdic::detail::scenario {

/// Columns of numbers and where each of them came from.
struct Columns {
  std::vector<std::vector<double>> values;  ///< [names][rows]
  TomlTable* table = nullptr;
  std::string csv_file;  ///< "" when they stand in the scenario itself
  std::vector<int> csv_lines;
  std::vector<std::string> names;
  std::vector<Quantity> quantities;  ///< [names]

  [[nodiscard]] std::size_t rows() const { return values[0].size(); }
  [[nodiscard]] InputError fault(std::size_t column, std::size_t row, const std::string& expected,
                                 std::string_view unit) const;
};

/// The named arrays of a table. All have as many rows as the first.
/// \throws InputError at the first number that is not of its quantity
[[nodiscard]] Columns read_lists(TomlTable& table,
                                 const std::vector<std::pair<std::string, Quantity>>& wanted);

/// The same, or the columns of the CSV file that the table's `file` names.
/// \throws InputError at the first number that is not of its quantity
[[nodiscard]] Columns read_columns(TomlTable& table, const std::filesystem::path& folder,
                                   const std::vector<std::pair<std::string, Quantity>>& wanted);

/// \throws InputError at the first value of the first column that is not beyond the one before it
void require_increasing(const Columns& columns);
/// The same, where two equal ones are a step.
void require_not_falling(const Columns& columns);

/// The CSV file that `file` names.
[[nodiscard]] CsvTable read_csv_of(TomlTable& table, const std::filesystem::path& folder);

}  // namespace asdic::detail::scenario
