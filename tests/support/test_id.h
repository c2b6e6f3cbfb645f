#pragma once
#include <cctype>
#include <string>

namespace asdic::detail::support {

/// A name of a case as Google Test takes it: letters and digits alone.
inline std::string test_id(std::string name) {
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
}

}  // namespace asdic::detail::support
