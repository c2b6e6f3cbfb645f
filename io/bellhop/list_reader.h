#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace asdic::detail::bellhop {

/// A number as Fortran writes it: "1", "-.5", "1.5D3", "2.5E-3", "1.5+3". Nothing if it is not one,
/// or not finite.
[[nodiscard]] std::optional<double> fortran_number(std::string_view text) noexcept;

/// Reads text as Fortran's list-directed READ does.
///
/// Items are parted by blanks, tabs, line ends or a comma; strings may stand in quotes of either
/// kind, a doubled quote is one; `3*0.5` repeats; two commas in a row leave an item out; `/` leaves
/// out all that are still to come; a statement that wants more goes on to the next line, and what
/// is left on its last line is dropped. A byte order mark in front of all is skipped. So every
/// statement is: begin(), the items, end().
class ListReader {
 public:
  /// \param text  must outlive the reader   \param file  its name, for messages
  ListReader(std::string_view text, std::string file);

  /// Starts a statement. \param field  what it holds, for messages: "bottom half space"
  void begin(std::string field);
  /// Ends it: the next one starts on a new line.
  void end();
  /// The number that still stands on this line after the last item, and would be dropped; empty if
  /// the line ends, or goes on with something else (a comment).
  [[nodiscard]] std::string number_left() const;

  // One item each: false, and `value` as it was, if it is left out. \param item  its name
  // \throws InputError  what stands there is something else, or 1e30 or more, or the file ends
  bool real(double& value, std::string_view item);
  bool integer(std::int64_t& value, std::string_view item);
  bool text(std::string& value, std::string_view item);

  /// The same for items that cannot be left out.
  double need_real(std::string_view item);
  std::int64_t need_integer(std::string_view item, std::int64_t least, std::int64_t most);

  /// Whether nothing but blank lines is left.
  [[nodiscard]] bool at_end() const noexcept;
  /// Line of the last item read, from 1.
  [[nodiscard]] std::size_t line() const noexcept { return item_line_; }
  [[nodiscard]] std::size_t size() const noexcept { return text_.size(); }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }

  /// "case.env:12: bottom half space: density": the last item read.
  [[nodiscard]] std::string where(std::string_view item) const;
  /// Complains about the last item read. \throws InputError always
  [[noreturn]] void fail(std::string_view item, std::string got, std::string expected) const;

 private:
  struct Item {
    std::string text;
    bool quoted = false;
  };
  std::optional<Item> next(std::string_view item, std::string_view expected);
  void skip_blanks(bool lines);
  [[nodiscard]] Item quoted(std::string_view item);
  [[nodiscard]] bool more() const noexcept { return position_ < text_.size(); }

  std::string_view text_;
  std::string file_, field_;
  std::size_t position_ = 0, line_ = 1, item_line_ = 1;
  bool closed_ = false;    // a slash has ended the statement
  bool separated_ = true;  // no comma belongs to an item before
  std::int64_t repeats_ = 0;
  std::optional<Item> repeated_;
};

/// What was found, for a message: in quotes, cut short, without what a terminal would obey.
[[nodiscard]] std::string shown(std::string_view text);
[[nodiscard]] std::string shown(double value);

}  // namespace asdic::detail::bellhop
