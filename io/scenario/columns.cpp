#include "io/scenario/columns.h"

#include "io/text/quote.h"

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

Columns read_columns(TomlTable& table, const std::filesystem::path& folder,
                     const std::vector<std::pair<std::string, Quantity>>& wanted) {
  Columns columns;
  columns.table = &table;
  for (const auto& [name, quantity] : wanted) columns.names.push_back(name);
  if (table.has("file")) {
    const CsvTable csv = read_csv_of(table, folder);
    columns.csv_file = csv.file;
    columns.csv_lines = csv.lines;
    for (const std::string& name : columns.names) columns.values.push_back(csv.column(name));
  } else {
    for (const auto& [name, quantity] : wanted)
      columns.values.push_back(table.numbers(name, quantity));
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto& [name, quantity] = wanted[i];
    if (columns.values[i].size() != columns.rows())
      throw table.fault(
          name, "as many values as " + columns.names[0] + "s, " + std::to_string(columns.rows()));
    for (std::size_t row = 0; row < columns.rows(); ++row)
      if (!quantity.holds(columns.values[i][row]))
        throw columns.fault(i, row, quantity.expected(), quantity.unit);
  }
  return columns;
}

void require_increasing(const Columns& columns, std::string_view unit) {
  const std::string& name = columns.names[0];
  const std::string side = name == "depth" ? "below" : "above";
  for (std::size_t row = 1; row < columns.rows(); ++row)
    if (columns.values[0][row] <= columns.values[0][row - 1])
      throw columns.fault(0, row,
                          "a " + name + " " + side + " the one before it, " +
                              to_text(columns.values[0][row - 1]) + " " + std::string(unit),
                          unit);
}

}  // namespace asdic::scenario
