#pragma once
#include <string>

#include "sonar/ping/ping.h"

namespace asdic::detail::app {

/// What `asdic validate` says of platforms, transmitters, arrays, targets, noise and reverberation:
/// a line each.
[[nodiscard]] std::string sonar_text(const PingSimulator& simulator);

}  // namespace asdic::detail::app
