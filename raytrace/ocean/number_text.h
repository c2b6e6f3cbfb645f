#pragma once
#include <cstddef>
#include <sstream>
#include <string>

/// Numbers and places in the messages of this folder.
namespace asdic::detail {

inline std::string with_unit(double value, const char* unit) {
  std::ostringstream text;
  text << value << ' ' << unit;
  return text.str();
}

inline std::string element(const char* array, std::size_t i) {
  return std::string(array) + '[' + std::to_string(i) + ']';
}

}  // namespace asdic::detail
