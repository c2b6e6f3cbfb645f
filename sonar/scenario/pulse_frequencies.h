#pragma once
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Of all transmitters.
[[nodiscard]] PulseFrequencies pulse_frequencies(const Scenario& scenario);

}  // namespace asdic::detail
