#include <array>

#include "sonar/noise/noise_spectrum.h"
#include "sonar/warnings/warnings.h"

namespace asdic::checks {

std::string noise_law_range(const Scenario& scenario) {
  if (!scenario.noise.law) return "";
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const std::array<Asked, 1> asked{{{"frequency", pulse.lowest, pulse.highest}}};
  std::string text;
  if (std::holds_alternative<WenzNoise>(*scenario.noise.law))
    text = outside(wenz_validity(), asked);
  else if (std::holds_alternative<KnudsenNoise>(*scenario.noise.law))
    text = outside(knudsen_validity(), asked);
  return text.empty() ? "" : "noise.kind: " + text;
}

}  // namespace asdic::checks
