#include "serve/turns.h"

#include <tuple>

namespace asdic::serve {

Turns::Turns(const Scenario& scenario) : anchors_(scenario.transmitters.size()) {
  for (std::size_t t = 0; t < anchors_.size(); ++t)
    anchors_[t].time = scenario.transmitters[t].first_ping_time;
}

Transmission Turns::next(const Scenario& scenario, int transmitter) const {
  const auto t = static_cast<std::size_t>(transmitter);
  const Transmitter& one = scenario.transmitters[t];
  const Anchor& anchor = anchors_[t];
  const auto& sweep = one.elevations.empty() ? scenario.pings.elevations : one.elevations;
  const auto turn = static_cast<std::size_t>(anchor.next - 1);
  return {.transmitter = transmitter,
          .turn = anchor.next,
          .time = anchor.time + static_cast<double>(anchor.next - anchor.turn) *
                                    one.interval.value_or(scenario.pings.interval),
          .elevation = sweep.empty() ? one.elevation : sweep[turn % sweep.size()]};
}

Transmission Turns::next(const Scenario& scenario) const {
  Transmission first = next(scenario, 0);
  for (int t = 1; t < static_cast<int>(anchors_.size()); ++t) {
    const Transmission one = next(scenario, t);
    if (std::tie(one.time, one.transmitter) < std::tie(first.time, first.transmitter)) first = one;
  }
  return first;
}

void Turns::sent(const Transmission& one, bool moved) {
  Anchor& anchor = anchors_[static_cast<std::size_t>(one.transmitter)];
  anchor.next = one.turn + 1;
  if (!moved) return;  // so that times stay multiples of the interval, bit for bit
  anchor.turn = one.turn;
  anchor.time = one.time;
}

}  // namespace asdic::serve
