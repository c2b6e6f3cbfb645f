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

}  // namespace

bool CsvTable::has(const std::string& name) const {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const std::vector<double>& CsvTable::column(const std::string& name) const {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) {
    std::string header;
    for (const std::string& have : names) header += (header.empty() ? "" : ",") + have;
    throw InputError({.where = file,
                      .got = "the columns " + in_quotes(header),
                      .expected = "a column " + in_quotes(name)});
  }
  return columns[static_cast<std::size_t>(it - names.begin())];
}

CsvTable read_csv(const std::filesystem::path& path) {
  const std::string text = read_text_file(path, "a readable CSV file");
  CsvTable table;
  table.file = path.string();
  std::istringstream stream(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string_view content = trim(line);
    if (content.empty() || content.front() == '#') continue;
    const std::string where = table.file + ":" + std::to_string(number);
    const auto cells = fields(content);
    if (table.names.empty()) {
      for (const std::string_view cell : cells) {
        std::string name(cell);
        std::transform(name.begin(), name.end(), name.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (name.empty() || table.has(name))
          throw InputError({.where = where,
                            .got = "the column name " + in_quotes(name),
                            .expected = "names that differ and are not empty"});
        table.names.push_back(std::move(name));
      }
      table.columns.resize(table.names.size());
      continue;
    }
    if (cells.size() != table.names.size())
      throw InputError({.where = where,
                        .got = std::to_string(cells.size()) + " fields",
                        .expected = std::to_string(table.names.size()) + " as in the header"});
    for (std::size_t i = 0; i < cells.size(); ++i) {
      double value = 0.0;
      const std::string_view cell = cells[i].starts_with('+') ? cells[i].substr(1) : cells[i];
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
        throw InputError({.where = where + ": " + table.names[i],
                          .got = in_quotes(cells[i]),
                          .expected = "a finite number"});
      table.columns[i].push_back(value);
    }
    table.lines.push_back(number);
  }
  if (table.lines.empty())
    throw InputError({.where = table.file,
                      .got = table.names.empty() ? "an empty file" : "a header without rows",
                      .expected = "a header and at least one row of numbers"});
  return table;
}

std::string read_text_file(const std::filesystem::path& path, const std::string& expected) {
  return read_input(path, expected);
}

}  // namespace asdic::detail
