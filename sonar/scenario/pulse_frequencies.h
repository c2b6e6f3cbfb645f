#pragma once
#include "sonar/scenario/scenario.h"

namespace asdic {

/// Frequencies that a pulse goes through, from the lowest to the highest [Hz].
struct PulseFrequencies {
  double lowest = 0.0, highest = 0.0;
};
/// Of all transmitters.
[[nodiscard]] PulseFrequencies pulse_frequencies(const Scenario& scenario);

}  // namespace asdic
