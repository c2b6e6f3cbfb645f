#include "app/warn.h"

#include "app/console.h"

namespace asdic::detail::app {

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& one : warnings) tell("asdic: warning: " + one);
}

}  // namespace asdic::detail::app
