#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"

namespace asdic::detail::app {

/// Whether people see what is written there.
[[nodiscard]] bool stdout_is_terminal() noexcept;
[[nodiscard]] bool stderr_is_terminal() noexcept;

/// Writes to standard output. \throws RunError if it cannot be written (a full disk)
void print(std::string_view text);
/// Hands everything to the system. \throws RunError as print()
void flush_output();

/// Bold, on a terminal that has not asked for plain text (NO_COLOR); else as it is.
[[nodiscard]] std::string emphasised(std::string_view text);

/// A table for people: a line of names, a line of units, aligned columns.
class Table {
 public:
  struct Column {
    std::string name{}, unit{};
    bool left = false;  ///< text; numbers stand to the right
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// \param cells  one per column
  void row(std::vector<std::string> cells);
  [[nodiscard]] std::string text() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// A number with so many decimals; "-" if there is none (NaN or −∞).
[[nodiscard]] std::string number(double value, int decimals);
/// Seconds as people say them: 0.0123 s, 3.2 s, 2 min 5 s.
[[nodiscard]] std::string duration(double seconds);
/// 12.3 kB, 61.5 MB (powers of ten).
[[nodiscard]] std::string byte_count(double bytes);

}  // namespace asdic::detail::app
