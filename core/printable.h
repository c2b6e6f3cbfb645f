#pragma once
#include <string>
#include <string_view>

namespace asdic::detail {

/// Text that came out of a file, for a terminal: control characters (of C0, C1 and DEL), marks that
/// turn the direction of writing, and bytes that are no UTF-8 are told as "\n", "\t", "\x1b",
/// "\u202e", "\xff"; all else is as it was. What has been made printable stays as it is, and what
/// is JSON stays JSON.
[[nodiscard]] std::string printable(std::string_view text);

/// The same for text of several lines: line ends and tabs stay.
[[nodiscard]] std::string printable_lines(std::string_view text);

}  // namespace asdic::detail
