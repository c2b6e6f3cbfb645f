#include "app/warn.h"

#include <fmt/format.h>

#include <cstdio>

namespace asdic::detail::app {

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& one : warnings) fmt::print(stderr, "asdic: warning: {}\n", one);
}

}  // namespace asdic::detail::app
