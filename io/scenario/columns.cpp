#include "io/scenario/columns.h"

#include "core/text.h"

namespace asdic::scenario {

InputError Columns::fault(std::size_t column, std::size_t row, const std::string& expected,
                          std::string_view unit) const {
  const std::string got = to_text(values[column][row]) + " " + std::string(unit);
  if (csv_file.empty())
    return table->fault(names[column] + "[" + std::to_string(row) + "]", expected, got);
  return InputError(
      {.where = csv_file + ":" + std::to_string(csv_lines[row]) + ": " + names[column],
       .got = got,
       .expected = expected});
}

CsvTable read_csv_of(TomlTable& table, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / table.text("file");
  if (!std::filesystem::exists(path))
    throw table.fault("file", "a readable CSV file", "no such file " + in_quotes(path.string()));
  return read_csv(path);
}

namespace {

Columns columns_of(TomlTable& table, const std::vector<std::pair<std::string, Quantity>>& wanted) {
  Columns columns;
  columns.table = &table;
  for (const auto& [name, quantity] : wanted) {
    columns.names.push_back(name);
    columns.quantities.push_back(quantity);
  }
  return columns;
}

/// \throws InputError at a column longer or shorter than the first, or a number out of its range
void check_columns(const Columns& columns) {
  for (std::size_t i = 0; i < columns.names.size(); ++i) {
    const Quantity& quantity = columns.quantities[i];
    if (columns.values[i].size() != columns.rows())
      throw columns.table->fault(columns.names[i], "as many values as " +
                                                       std::string(columns.quantities[0].noun) +
                                                       "s, " + std::to_string(columns.rows()));
    for (std::size_t row = 0; row < columns.rows(); ++row)
      if (!quantity.holds(columns.values[i][row]))
        throw columns.fault(i, row, quantity.expected(), quantity.unit);
  }
}

}  // namespace

Columns read_lists(TomlTable& table, const std::vector<std::pair<std::string, Quantity>>& wanted) {
  Columns columns = columns_of(table, wanted);
  for (const auto& [name, quantity] : wanted)
    columns.values.push_back(table.numbers(name, quantity));
  check_columns(columns);
  return columns;
}

Columns read_columns(TomlTable& table, const std::filesystem::path& folder,
                     const std::vector<std::pair<std::string, Quantity>>& wanted) {
  if (!table.has("file")) return read_lists(table, wanted);
  Columns columns = columns_of(table, wanted);
  const CsvTable csv = read_csv_of(table, folder);
  columns.csv_file = csv.file;
  columns.csv_lines = csv.lines;
  for (const std::string& name : columns.names) columns.values.push_back(csv.column(name));
  check_columns(columns);
  return columns;
}

void require_increasing(const Columns& columns) {
  const Quantity& first = columns.quantities[0];
  const std::string side = first.noun == "depth" ? "below" : "above";
  for (std::size_t row = 1; row < columns.rows(); ++row)
    if (columns.values[0][row] <= columns.values[0][row - 1])
      throw columns.fault(0, row,
                          with_article(first.noun) + " " + side + " the one before it, " +
                              to_text(columns.values[0][row - 1]) + " " + std::string(first.unit),
                          first.unit);
}

}  // namespace asdic::scenario
