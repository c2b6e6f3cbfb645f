#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"

namespace asdic::detail::app {

/// Whether people see what is written there.
[[nodiscard]] bool stdout_is_terminal() noexcept;
[[nodiscard]] bool stderr_is_terminal() noexcept;

/// How wide the terminal behind standard output or error (1, 2) is; where there is none, what
/// COLUMNS says, or 80. Never below 20.
[[nodiscard]] std::size_t terminal_width(int stream);
/// As wide as help is: COLUMNS goes first, as in other programs.
[[nodiscard]] std::size_t help_width();

/// How many columns UTF-8 text takes: one a code point, which is right for all that we print.
[[nodiscard]] std::size_t columns_of(std::string_view text);
/// What of it fits into so many columns; "…" stands for the rest.
[[nodiscard]] std::string cut_to(std::string_view text, std::size_t columns);
/// Text in lines of at most `width` columns, broken at spaces, with an end of line. Spaces at its
/// begin stay; a word that is longer has a line of its own. \param indent  of all lines but the
/// first \param mark  at the end of a line that goes on: " " for a shell
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t width, std::size_t indent,
                                  std::string_view mark = "");

/// A line to people on standard error; a line of progress that stands there is taken away, and
/// drawn anew below.
void tell(const std::string& line);
/// Draws a line of progress in place of the one before; "" takes it away.
void draw_progress(const std::string& line);

/// Writes bytes to standard output as they are. \throws RunError if they cannot be written
void write_output(std::string_view bytes);
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
