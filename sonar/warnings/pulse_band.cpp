#include <cstdio>

#include "sonar/warnings/warnings.h"

namespace asdic::detail::checks {

std::string pulse_band(const Scenario& scenario) {
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const PulseSettings& settings = pulse_of(scenario, static_cast<int>(t));
    if (samples_of(settings.waveform)) continue;
    const Pulse pulse(settings);
    if (0.5 * pulse.bandwidth_40db() < pulse.centre_frequency()) continue;
    char text[160];
    std::snprintf(text, sizeof text,
                  "pulse: its band, %g Hz wide about %g Hz, reaches down to 0 Hz: frequencies are "
                  "in Hz, not kHz",
                  pulse.bandwidth_40db(), pulse.centre_frequency());
    return text;
  }
  return "";
}

}  // namespace asdic::detail::checks
