#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"
#include "io/text/toml_value.h"

namespace asdic::detail {

inline constexpr std::size_t most_in_a_line = 12;  ///< numbers of a list

/// TOML text, table by table. Numbers are the shortest that read back as the same bits.
class TomlWriter {
 public:
  void comment(std::string_view text);
  void table(std::string_view path);        ///< [path], after a blank line
  void array_table(std::string_view path);  ///< [[path]]
  void number(std::string_view key, double value);
  void integer(std::string_view key, long long value);
  void flag(std::string_view key, bool value);
  void text(std::string_view key, std::string_view value);
  void numbers(std::string_view key, std::span<const double> values);
  /// One line a row. \param columns  of a row
  void rows(std::string_view key, std::span<const double> values, std::size_t columns);
  /// Radians, under NAME_deg if that can be exact, else under NAME_rad.
  void angle(const std::string& name, double radians);
  void angles(const std::string& name, std::span<const double> radians);
  /// Anything, as it stands.
  void line(std::string_view key, std::string_view value);

  [[nodiscard]] const std::string& str() const noexcept { return text_; }

 private:
  std::string text_;
};

/// A number as TOML takes it: like to_text(), but −0 keeps its sign.
[[nodiscard]] std::string toml_number(double value);

/// A key as it may stand in a path: bare where it can be.
[[nodiscard]] std::string toml_key(const std::string& key);

/// A value on one line: {"name" = "ship", "position" = [0, 0, 100]}. Numbers read back as the same
/// bits.
[[nodiscard]] std::string inline_toml(const TomlValue& value);

/// Degrees that radians() turns into exactly these bits, the shortest near; empty if there are
/// none.
[[nodiscard]] std::string exact_degrees(double radians);

}  // namespace asdic::detail
