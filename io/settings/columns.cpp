#include "io/settings/columns.h"

#include "core/text.h"

namespace asdic::detail::scenario {

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

namespace {

/// \param allowed  of a value and the one before it   \param side  "below", "not above"
template <class Allowed>
void require_rows_in_order(const Columns& columns, const Allowed& allowed,
                           const std::string& side) {
  const Quantity& first = columns.quantities[0];
  for (std::size_t row = 1; row < columns.rows(); ++row)
    if (const double before = columns.values[0][row - 1]; !allowed(columns.values[0][row], before))
      throw columns.fault(0, row,
                          with_article(first.noun) + " " + side + " the one before it, " +
                              to_text(before) + " " + std::string(first.unit),
                          first.unit);
}

bool is_depth(const Columns& columns) { return columns.quantities[0].noun == "depth"; }

/// Least distance of two rows: 1 µm for places, because no sea is known more finely; else none.
double least_step(const Columns& columns) { return columns.quantities[0].unit == "m" ? 1e-6 : 0.0; }

}  // namespace

void require_increasing(const Columns& columns) {
  const double least = least_step(columns);
  require_rows_in_order(
      columns,
      [least](double value, double before) { return value > before && value - before >= least; },
      is_depth(columns) ? "below" : "above");
}

void require_not_falling(const Columns& columns) {
  const double least = least_step(columns);
  require_rows_in_order(
      columns,
      [least](double value, double before) { return value == before || value - before >= least; },
      is_depth(columns) ? "not above" : "not below");
}

}  // namespace asdic::detail::scenario
