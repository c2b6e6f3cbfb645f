#include "sonar/ping/recorded_replica.h"

#include "sonar/scenario/sampling.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

std::vector<float> recorded_replica(const Scenario& scenario, int transmitter) {
  const Pulse pulse(pulse_of(scenario, transmitter));
  const double rate = recorded_rate(scenario), carrier = recorded_carrier(scenario);
  return carrier > 0.0 ? baseband_replica(pulse, rate, carrier) : replica(pulse, rate);
}

}  // namespace asdic::detail
