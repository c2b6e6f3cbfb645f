#pragma once
#include <span>
#include <string>

namespace asdic::detail::study {

/// "a", "b" or "c"
[[nodiscard]] std::string list_of(std::span<const std::string> names);

}  // namespace asdic::detail::study
