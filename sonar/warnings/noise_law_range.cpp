#include <array>

#include "sonar/warnings/warnings.h"

namespace asdic::detail::checks {

std::string noise_law_range(const Scenario& scenario) {
  if (!scenario.noise.law) return "";
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const std::array<Asked, 1> asked{{{"frequency", pulse.lowest, pulse.highest}}};
  const std::string text = std::visit(
      [&](const auto& law) { return outside(law.validity(), asked); }, *scenario.noise.law);
  return text.empty() ? "" : "noise.kind: " + text;
}

}  // namespace asdic::detail::checks
