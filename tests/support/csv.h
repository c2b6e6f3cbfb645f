#pragma once
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace asdic::detail::support {

/// A table out of tests/data or the data of a folder of tests: one header line with the columns,
/// then rows.
///
///     const support::Csv csv("physics-reference/munk_profile.csv");
///     for (std::size_t row = 0; row < csv.rows(); ++row) use(csv["depth_m"][row]);
///
/// Lines that start with '#' and empty lines are skipped. A cell that is not a number ("sand",
/// "7-12", "nan") reads as NaN and can be had as text. Anything else amiss (no such file or
/// column, a ragged row) throws std::runtime_error: a test must not pass because its data is
/// missing.
class Csv {
 public:
  explicit Csv(const std::string& name) : name_(name) {
    std::ifstream file(path_of(name));
    if (!file) throw std::runtime_error("cannot open test data " + name);
    for (std::string line; std::getline(file, line);) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.empty() || line.front() == '#') continue;
      if (header_.empty()) {
        header_ = split(line);
        text_.resize(header_.size());
        numbers_.resize(header_.size());
      } else {
        append(split(line));
      }
    }
    if (rows() == 0) throw std::runtime_error(name + " has no rows");
  }

  [[nodiscard]] std::size_t rows() const { return text_.empty() ? 0 : text_.front().size(); }
  [[nodiscard]] const std::vector<std::string>& columns() const { return header_; }

  /// [rows] a column as numbers
  [[nodiscard]] const std::vector<double>& operator[](std::string_view column) const {
    return numbers_[index(column)];
  }
  /// [rows] a column as it is written
  [[nodiscard]] const std::vector<std::string>& text(std::string_view column) const {
    return text_[index(column)];
  }

 private:
  /// In tests/data, else in the only tests/*/data that has it.
  static std::filesystem::path path_of(const std::string& name) {
    const std::filesystem::path shared = std::filesystem::path(ASDIC_TEST_DATA) / name;
    if (exists(shared)) return shared;
    for (const auto& folder :
         std::filesystem::directory_iterator(std::filesystem::path(ASDIC_TEST_DATA) / ".."))
      if (const auto own = folder.path() / "data" / name; exists(own)) return own;
    return shared;
  }

  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (line.back() == ',') cells.emplace_back();
    return cells;
  }

  static double number(const std::string& cell) {
    double value = 0.0;
    const char* end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data(), end, value);
    return error == std::errc{} && stop == end ? value : std::numeric_limits<double>::quiet_NaN();
  }

  void append(const std::vector<std::string>& cells) {
    if (cells.size() != header_.size())
      throw std::runtime_error(name_ + ": row " + std::to_string(rows() + 1) + " has " +
                               std::to_string(cells.size()) + " cells, the header " +
                               std::to_string(header_.size()));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text_[i].push_back(cells[i]);
      numbers_[i].push_back(number(cells[i]));
    }
  }

  [[nodiscard]] std::size_t index(std::string_view column) const {
    const auto found = std::find(header_.begin(), header_.end(), column);
    if (found == header_.end())
      throw std::runtime_error(name_ + " has no column " + std::string(column));
    return static_cast<std::size_t>(found - header_.begin());
  }

  std::string name_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> text_;  // [column][row]
  std::vector<std::vector<double>> numbers_;    // [column][row]
};

}  // namespace asdic::detail::support
