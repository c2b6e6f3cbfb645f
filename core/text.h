#pragma once
#include <cstdarg>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

/// How values and words are told in messages.
namespace asdic::detail {

/// The shortest decimal that reads back as the same number.
[[nodiscard]] std::string to_text(double number);

/// Text as printf formats it, of any length.
[[nodiscard, gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);
[[nodiscard]] std::string formatted_list(const char* format, std::va_list values);

/// "a depth", "an aspect".
[[nodiscard]] std::string with_article(std::string_view noun);

/// A word of the user's: "word", with its quotes.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// "1 phone", "2 phones".
[[nodiscard]] std::string count_of(std::size_t n, std::string_view thing);

/// The nearest of `names` to a mistyped one, or "" when none is near.
[[nodiscard]] std::string nearest_name(std::string_view typed, std::span<const std::string> names);

}  // namespace asdic::detail
