#pragma once
#include <string>
#include <vector>

namespace asdic::detail::app {

/// What a user should know before he trusts the numbers: "asdic: warning: ..." a line, on standard
/// error.
void warn(const std::vector<std::string>& warnings);

}  // namespace asdic::detail::app
