#pragma once
#include <cstdlib>
#include <string_view>

namespace asdic::detail::support {

/// Whether a test is to run in its full form, as scripts/deep_check.sh asks for: ASDIC_DEEP=1.
inline bool deep() {
  const char* asked = std::getenv("ASDIC_DEEP");
  return asked != nullptr && std::string_view(asked) == "1";
}

}  // namespace asdic::detail::support
