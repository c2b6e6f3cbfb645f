#include <cstdio>

#include "sonar/noise/noise_in_guide.h"
#include "sonar/warnings/warnings.h"

namespace asdic::detail::checks {

std::string noise_from_below(const Scenario& scenario) {
  constexpr double received = 0.1;  // of what comes down
  if (!scenario.noise.any() || scenario.noise.coherence != NoiseCoherence::surface ||
      !varies_with_range(scenario.environment))
    return "";
  const SentUp most = sent_up(scenario.environment, pulse_frequencies(scenario).lowest);
  if (most.share < received) return "";
  char text[280];
  std::snprintf(
      text, sizeof text,
      "noise.coherence: in an ocean that varies with range \"surface\" is the sheet of sources "
      "above alone; what the bottom sends up again, %.2g dB of it at %.0f degrees, is left out; a "
      "level over elevation (\"profile\") can hold it",
      db_from_power(most.share), degrees(most.angle));
  return text;
}

}  // namespace asdic::detail::checks
