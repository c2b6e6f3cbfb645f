#include "core/printable.h"

#include <array>
#include <cstdint>
#include <cstdio>

#include "core/utf8.h"

namespace asdic::detail {
namespace {

/// Moves the cursor, changes colours, or turns what follows around.
bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x061C ||
         (code >= 0x200E && code <= 0x200F) || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

std::string escaped(std::uint32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\r') return "\\r";
  if (code == '\t') return "\\t";
  std::array<char, 12> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), code < 0x7F ? "\\x%02x" : "\\u%04x",
                                  static_cast<unsigned>(code)));
  return text.data();
}

std::string no_character(char byte) {
  std::array<char, 8> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "\\x%02x",
                                  static_cast<unsigned>(static_cast<unsigned char>(byte))));
  return text.data();
}

std::string printable(std::string_view text, bool lines) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Utf8Character c = first_character(text);
    const std::size_t bytes = c.bytes > 0 ? c.bytes : 1;
    if (lines && (c.code == '\n' || c.code == '\t') && c.bytes == 1)
      result += text.front();
    else if (c.bytes == 0)
      result += no_character(text.front());
    else if (is_control(c.code))
      result += escaped(c.code);
    else
      result += text.substr(0, bytes);
    text.remove_prefix(bytes);
  }
  return result;
}

}  // namespace

std::string printable(std::string_view text) { return printable(text, false); }
std::string printable_lines(std::string_view text) { return printable(text, true); }

}  // namespace asdic::detail
