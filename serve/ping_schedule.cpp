#include "serve/ping_schedule.h"

#include <tuple>

namespace asdic::detail::serve {

PingSchedule::PingSchedule(const Scenario& scenario) : anchors_(scenario.transmitters.size()) {
  for (std::size_t t = 0; t < anchors_.size(); ++t)
    anchors_[t].time = scenario.transmitters[t].first_ping_time;
}

Transmission PingSchedule::next(const Scenario& scenario, int transmitter) const {
  const auto t = static_cast<std::size_t>(transmitter);
  const Transmitter& one = scenario.transmitters[t];
  const Anchor& anchor = anchors_[t];
  const auto& sweep = one.elevations.empty() ? scenario.pings.elevations : one.elevations;
  const auto own_ping = static_cast<std::size_t>(anchor.next - 1);
  return {.transmitter = transmitter,
          .own_ping = anchor.next,
          .time = anchor.time + static_cast<double>(anchor.next - anchor.own_ping) *
                                    one.interval.value_or(scenario.pings.interval),
          .elevation = sweep.empty() ? one.elevation : sweep[own_ping % sweep.size()]};
}

Transmission PingSchedule::next(const Scenario& scenario) const {
  Transmission first = next(scenario, 0);
  for (int t = 1; t < static_cast<int>(anchors_.size()); ++t) {
    const Transmission one = next(scenario, t);
    if (std::tie(one.time, one.transmitter) < std::tie(first.time, first.transmitter)) first = one;
  }
  return first;
}

void PingSchedule::sent(const Transmission& one, bool moved) {
  Anchor& anchor = anchors_[static_cast<std::size_t>(one.transmitter)];
  anchor.next = one.own_ping + 1;
  if (!moved) return;  // so that times stay multiples of the interval, bit for bit
  anchor.own_ping = one.own_ping;
  anchor.time = one.time;
}

}  // namespace asdic::detail::serve
