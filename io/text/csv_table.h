#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace asdic::detail {

/// Numbers in columns under a header line.
struct CsvTable {
  std::string file;                          ///< for messages
  std::vector<std::string> names;            ///< [columns], lower case
  std::vector<std::vector<double>> columns;  ///< [columns][rows]
  std::vector<int> lines;                    ///< [rows] line in the file, from 1

  /// \throws InputError if there is no such column
  [[nodiscard]] const std::vector<double>& column(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& name) const;
};

/// Reads comma-separated finite numbers below one header line. Blank lines and lines that start
/// with # are skipped; spaces around fields, a byte-order mark and CRLF do no harm.
/// \throws InputError with the line and column at fault, or if the file cannot be read
[[nodiscard]] CsvTable read_csv(const std::filesystem::path& path);

/// The same of any texts: what is between commas, without spaces around it.
struct CsvText {
  std::string file;
  std::vector<std::string> names;               ///< [columns], lower case
  std::vector<std::vector<std::string>> cells;  ///< [columns][rows]
  std::vector<int> lines;                       ///< [rows] line in the file, from 1

  /// \throws InputError if there is no such column
  [[nodiscard]] std::size_t column(const std::string& name) const;
};
[[nodiscard]] CsvText read_csv_text(const std::filesystem::path& path);

/// A field as a finite number; nothing for what is none.
[[nodiscard]] std::optional<double> number_in(std::string_view field);

/// A whole file. \throws InputError naming it if it cannot be read
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path,
                                         const std::string& expected = "a readable file");

}  // namespace asdic::detail
