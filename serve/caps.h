#pragma once
#include <cstddef>

#include "serve/session_limits.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail::serve {

/// What can be seen of a scenario before anything is traced. (A ping asks for all of its memory
/// when it is made.) \throws Refusal ("limit") naming what is past which limit
void check_caps(const Scenario& scenario, const SessionLimits& limits);

}  // namespace asdic::detail::serve
