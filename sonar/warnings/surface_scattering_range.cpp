#include <array>

#include "reverb/scattering/validity.h"
#include "sonar/warnings/warnings.h"

namespace asdic::detail::checks {

std::string surface_scattering_range(const Scenario& scenario) {
  const ReverberationSettings& sea = scenario.reverberation;
  if (!sea.enabled || !sea.surface_scatters) return "";
  const PulseFrequencies pulse = pulse_frequencies(scenario);
  const std::array<Asked, 2> asked{{{"frequency", pulse.lowest, pulse.highest},
                                    {"wind speed", scenario.wind_speed, scenario.wind_speed}}};
  const std::string text = std::visit(
      [&]<class Law>(const Law& /*law*/) { return outside(scattering_validity<Law>, asked); },
      sea.surface);
  return text.empty() ? "" : "reverberation.surface.kind: " + text;
}

}  // namespace asdic::detail::checks
