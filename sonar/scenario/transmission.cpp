#include "sonar/scenario/transmission.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sonar/scenario/sampling.h"

namespace asdic::detail {

std::vector<Transmission> transmissions(const Scenario& scenario) {
  std::vector<Transmission> sent;
  const PingSchedule& schedule = scenario.pings;
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const Transmitter& transmitter = scenario.transmitters[t];
    const auto& sweep =
        transmitter.elevations.empty() ? schedule.elevations : transmitter.elevations;
    const double interval = transmitter.interval.value_or(schedule.interval);
    for (int own_ping = 1; own_ping <= schedule.count; ++own_ping) {
      const auto n = static_cast<std::size_t>(own_ping - 1);
      sent.push_back(
          {.transmitter = static_cast<int>(t),
           .own_ping = own_ping,
           .time = transmitter.first_ping_time + static_cast<double>(n) * interval,
           .elevation = sweep.empty() ? transmitter.elevation : sweep[n % sweep.size()]});
    }
  }
  if (schedule.continuous) {
    const double rate = recorded_rate(scenario);
    for (Transmission& one : sent) one.time = std::round(one.time * rate) / rate;
  }
  std::stable_sort(sent.begin(), sent.end(), [](const Transmission& a, const Transmission& b) {
    return std::tie(a.time, a.transmitter) < std::tie(b.time, b.transmitter);
  });
  return sent;
}

Transmitter projector_of(const Scenario& scenario, const Transmission& sent) {
  Transmitter projector = scenario.transmitters[static_cast<std::size_t>(sent.transmitter)];
  projector.elevation = sent.elevation;
  return projector;
}

Transmitter projector_of(const Scenario& scenario, int transmitter, int ping) {
  const std::vector<Transmission> sent = transmissions(scenario);
  const auto at = static_cast<std::size_t>(ping - 1);
  if (at < sent.size() && sent[at].transmitter == transmitter)
    return projector_of(scenario, sent[at]);
  return scenario.transmitters[static_cast<std::size_t>(transmitter)];
}

}  // namespace asdic::detail
