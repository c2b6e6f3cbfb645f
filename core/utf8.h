#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace asdic::detail {

/// A character of UTF-8 (RFC 3629: of the shortest form, no surrogates).
struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  ///< 0: no UTF-8
};

/// The first character of a text that is not empty.
[[nodiscard]] Utf8Character first_character(std::string_view text);

/// All of a text is UTF-8.
[[nodiscard]] bool is_utf8(std::string_view text);

/// Longest beginning of a text that fits into so many bytes without cutting a character.
[[nodiscard]] std::string_view cut_to_bytes(std::string_view text, std::size_t bytes);

/// Returns a text as valid UTF-8; U+FFFD takes the place of every byte that is not part of it.
[[nodiscard]] std::string as_utf8(std::string_view text);

}  // namespace asdic::detail
