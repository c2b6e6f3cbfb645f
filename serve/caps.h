#pragma once
#include <cstddef>

#include "serve/session_limits.h"
#include "sonar/scenario.h"

namespace asdic::serve {

/// Memory that a ping of a scenario may take: an upper bound out of its samples and returns.
[[nodiscard]] double ping_bytes(const Scenario& scenario);

/// \throws Refusal ("limit") naming what is past which limit
void check_caps(const Scenario& scenario, const SessionLimits& limits);

}  // namespace asdic::serve
