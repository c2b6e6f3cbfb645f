#pragma once
#include <string>
#include <string_view>

namespace asdic {

/// A word of the user's in a message: "word".
inline std::string in_quotes(std::string_view text) {
  std::string result(1, '"');
  result += text;
  result += '"';
  return result;
}

}  // namespace asdic
