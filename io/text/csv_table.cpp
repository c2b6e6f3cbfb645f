#include "io/text/csv_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "core/error.h"
#include "core/text.h"
#include "io/files/input_file.h"

namespace asdic::detail {
namespace {

std::string_view trim(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())))
    text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
    text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> fields(std::string_view line) {
  std::vector<std::string_view> result;
  for (std::size_t start = 0; start <= line.size();) {
    const auto comma = std::min(line.find(',', start), line.size());
    result.push_back(trim(line.substr(start, comma - start)));
    start = comma + 1;
  }
  return result;
}

std::size_t place_of(const std::vector<std::string>& names, const std::string& name,
                     const std::string& file) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) {
    std::string header;
    for (const std::string& have : names) header += (header.empty() ? "" : ",") + have;
    throw InputError({.where = file,
                      .got = "the columns " + in_quotes(header),
                      .expected = "a column " + in_quotes(name)});
  }
  return static_cast<std::size_t>(it - names.begin());
}

/// Header and rows, in order. \param row  gets the fields of a line, and its number
template <class Row>
void read_lines(const std::filesystem::path& path, std::vector<std::string>& names, Row&& row) {
  const std::string text = read_text_file(path, "a readable CSV file");
  const std::string file = path.string();
  std::istringstream stream(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text);
  std::string line;
  bool any = false;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string_view content = trim(line);
    if (content.empty() || content.front() == '#') continue;
    const std::string where = file + ":" + std::to_string(number);
    const auto cells = fields(content);
    if (names.empty()) {
      for (const std::string_view cell : cells) {
        std::string name(cell);
        std::transform(name.begin(), name.end(), name.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (name.empty() || std::find(names.begin(), names.end(), name) != names.end())
          throw InputError({.where = where,
                            .got = "the column name " + in_quotes(name),
                            .expected = "names that differ and are not empty"});
        names.push_back(std::move(name));
      }
      continue;
    }
    if (cells.size() != names.size())
      throw InputError({.where = where,
                        .got = std::to_string(cells.size()) + " fields",
                        .expected = std::to_string(names.size()) + " as in the header"});
    row(cells, number);
    any = true;
  }
  if (!any)
    throw InputError({.where = file,
                      .got = names.empty() ? "an empty file" : "a header without rows",
                      .expected = "a header and at least one row of numbers"});
}

}  // namespace

bool CsvTable::has(const std::string& name) const {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const std::vector<double>& CsvTable::column(const std::string& name) const {
  return columns[place_of(names, name, file)];
}

std::size_t CsvText::column(const std::string& name) const { return place_of(names, name, file); }

std::optional<double> number_in(std::string_view field) {
  double value = 0.0;
  const std::string_view cell = field.starts_with('+') ? field.substr(1) : field;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

CsvTable read_csv(const std::filesystem::path& path) {
  CsvTable table;
  table.file = path.string();
  read_lines(path, table.names, [&](const auto& cells, int number) {
    table.columns.resize(table.names.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::optional<double> value = number_in(cells[i]);
      if (!value)
        throw InputError(
            {.where = table.file + ":" + std::to_string(number) + ": " + table.names[i],
             .got = in_quotes(cells[i]),
             .expected = "a finite number"});
      table.columns[i].push_back(*value);
    }
    table.lines.push_back(number);
  });
  return table;
}

CsvText read_csv_text(const std::filesystem::path& path) {
  CsvText table;
  table.file = path.string();
  read_lines(path, table.names, [&](const auto& cells, int number) {
    table.cells.resize(table.names.size());
    for (std::size_t i = 0; i < cells.size(); ++i) table.cells[i].emplace_back(cells[i]);
    table.lines.push_back(number);
  });
  return table;
}

std::string read_text_file(const std::filesystem::path& path, const std::string& expected) {
  return read_input(path, expected);
}

}  // namespace asdic::detail
