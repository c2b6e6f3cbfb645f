#include "sonar/scenario/pulse_frequencies.h"

#include <algorithm>
#include <cstddef>

namespace asdic::detail {

PulseFrequencies pulse_frequencies(const Scenario& scenario) {
  PulseFrequencies all{.lowest = infinity, .highest = 0.0};
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const PulseSettings& pulse = pulse_of(scenario, static_cast<int>(t));
    PulseFrequencies one;
    if (const auto through = frequencies_of(pulse.waveform, pulse.duration)) {
      one = *through;
    } else {
      const Pulse sent(pulse);
      const double half = 0.5 * sent.bandwidth_99();
      one = {std::max(0.0, sent.centre_frequency() - half), sent.centre_frequency() + half};
    }
    all.lowest = std::min(all.lowest, one.lowest);
    all.highest = std::max(all.highest, one.highest);
  }
  return all;
}

}  // namespace asdic::detail
