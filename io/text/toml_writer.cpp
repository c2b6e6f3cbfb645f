#include "io/text/toml_writer.h"

#include <cmath>
#include <cstdio>
#include <string>

#include "core/text.h"
#include "core/units.h"
#include "core/utf8.h"
#include "io/text/toml_value.h"

namespace asdic::detail {
namespace {

/// A basic string of TOML. Bytes that are not UTF-8 are taken as Latin-1, as old files have them.
std::string toml_quoted(std::string_view text) {
  std::string result = "\"";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c == '"' || c == '\\') {
      result += {'\\', static_cast<char>(c)};
    } else if (c < 0x20 || c == 0x7f) {
      constexpr char hex[] = "0123456789abcdef";
      result += {'\\', 'u', '0', '0', hex[c >> 4], hex[c & 15]};
    } else if (c < 0x80) {
      result += static_cast<char>(c);
    } else {
      const std::size_t length = first_character(text.substr(i)).bytes;
      if (length == 0) {
        result += {static_cast<char>(0xc0 | (c >> 6)), static_cast<char>(0x80 | (c & 63))};
      } else {
        result += text.substr(i, length);
        i += length - 1;
      }
    }
  }
  return result + "\"";
}

std::string list(std::span<const std::string> items) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i)
    text += (i == 0 ? "" : i % most_in_a_line == 0 ? ",\n  " : ", ") + items[i];
  return text + "]";
}

/// A value on one line.
struct Inline {
  std::string operator()(std::monostate) const { return "\"\""; }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(std::int64_t number) const { return std::to_string(number); }
  std::string operator()(double number) const { return toml_number(number); }
  std::string operator()(const std::string& text) const { return toml_quoted(text); }
  std::string operator()(const TomlValue::Array& items) const {
    std::string result;
    for (const TomlValue& item : items) result += (result.empty() ? "" : ", ") + inline_toml(item);
    return "[" + result + "]";
  }
  std::string operator()(const TomlValue::Table& entries) const {
    std::string result;
    for (const TomlEntry& entry : entries)
      result +=
          (result.empty() ? "" : ", ") + toml_quoted(entry.key) + " = " + inline_toml(entry.value);
    return "{" + result + "}";
  }
};

}  // namespace

std::string toml_number(double value) {
  return value == 0.0 && std::signbit(value) ? "-0.0" : to_text(value);
}

std::string exact_degrees(double angle) {
  const double near = degrees(angle);
  // Round numbers first: 12 digits are what a person might have written.
  char shorter[32] = {};
  std::snprintf(shorter, sizeof shorter, "%.12g", near);
  if (const double round = std::stod(shorter); radians(round) == angle) return toml_number(round);
  double below = near, above = near;
  for (int step = 0; step < 3; ++step) {
    for (const double candidate : {below, above})
      if (radians(candidate) == angle && std::signbit(candidate) == std::signbit(angle))
        return toml_number(candidate);
    below = std::nextafter(below, -infinity);
    above = std::nextafter(above, infinity);
  }
  return "";
}

void TomlWriter::line(std::string_view key, std::string_view value) {
  text_ += std::string(key) + " = " + std::string(value) + "\n";
}

void TomlWriter::comment(std::string_view text) { text_ += "# " + std::string(text) + "\n"; }

void TomlWriter::table(std::string_view path) {
  text_ += (text_.empty() ? "[" : "\n[") + std::string(path) + "]\n";
}

void TomlWriter::array_table(std::string_view path) {
  text_ += "\n[[" + std::string(path) + "]]\n";
}

void TomlWriter::number(std::string_view key, double value) { line(key, toml_number(value)); }

void TomlWriter::integer(std::string_view key, long long value) {
  line(key, std::to_string(value));
}

void TomlWriter::flag(std::string_view key, bool value) { line(key, value ? "true" : "false"); }

void TomlWriter::text(std::string_view key, std::string_view value) {
  line(key, toml_quoted(value));
}

void TomlWriter::numbers(std::string_view key, std::span<const double> values) {
  std::vector<std::string> items;
  for (const double value : values) items.push_back(toml_number(value));
  line(key, list(items));
}

void TomlWriter::rows(std::string_view key, std::span<const double> values, std::size_t columns) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t column = i % columns;
    text += column == 0 ? (i == 0 ? "[" : ",\n  [") : ", ";
    text += toml_number(values[i]);
    if (column + 1 == columns) text += "]";
  }
  line(key, text + "]");
}

void TomlWriter::angle(const std::string& name, double angle) {
  const std::string in_degrees = exact_degrees(angle);
  if (in_degrees.empty())
    number(name + "_rad", angle);
  else
    line(name + "_deg", in_degrees);
}

void TomlWriter::angles(const std::string& name, std::span<const double> angles) {
  std::vector<std::string> items;
  for (const double angle : angles) {
    items.push_back(exact_degrees(angle));
    if (items.back().empty()) return numbers(name + "_rad", angles);
  }
  line(name + "_deg", list(items));
}

std::string toml_key(const std::string& key) {
  const bool bare = !key.empty() && key.find_first_not_of(
                                        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789_-") == std::string::npos;
  return bare ? key : toml_quoted(key);
}

std::string inline_toml(const TomlValue& value) { return std::visit(Inline{}, value.data); }

}  // namespace asdic::detail
