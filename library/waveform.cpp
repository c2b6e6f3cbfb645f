#include <cmath>

#include "asdic/pulse.h"
#include "library/arguments.h"
#include "library/physics.h"
#include "sonar/scenario/sampling.h"
#include "sonar/signal/pulse.h"

namespace asdic {

Waveform waveform(const Scenario& scenario, int transmitter, std::optional<double> sample_rate) {
  return translated([&] {
    require("sample_rate", sample_rate,
            {.noun = "rate", .unit = "Hz", .low = 0.0, .high = 1e9, .above = true});
    const detail::Scenario& sonar = Access::physics(scenario).simulator().scenario();
    require("transmitter", transmitter, 0, static_cast<int>(sonar.transmitters.size()) - 1);
    const detail::Pulse pulse(detail::pulse_of(sonar, transmitter));
    const double highest = pulse.centre_frequency() + 0.5 * pulse.sampled_bandwidth();
    const double recorded =
        detail::recorded_carrier(sonar) > 0.0 ? 2.5 * highest : detail::recorded_rate(sonar);
    Waveform made{.sample_rate = sample_rate.value_or(recorded),
                  .source_level_db =
                      sonar.transmitters[static_cast<std::size_t>(transmitter)].source_level_db,
                  .centre_frequency = pulse.centre_frequency(),
                  .energy = pulse.energy()};
    const double samples = std::ceil(pulse.duration() * made.sample_rate) + 1.0;
    if (samples > 1e9)
      throw InputError("sample_rate", "one that makes more than 1e9 samples", "a lower one");
    made.analytic.reserve(static_cast<std::size_t>(samples));
    for (double i = 0.0; i < samples; ++i)
      made.analytic.push_back(pulse.analytic(i / made.sample_rate));
    return made;
  });
}

}  // namespace asdic
