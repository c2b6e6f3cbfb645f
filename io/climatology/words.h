#pragma once
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace asdic::detail::climatology {

/// Letter case does not matter in names and units of files.
[[nodiscard]] inline std::string lower(std::string_view text) {
  std::string word(text);
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

}  // namespace asdic::detail::climatology
