#include "core/text.h"
#include "io/scenario/sections.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail::scenario {

void check_intervals(TomlTable& root, const Scenario& scenario) {
  if (scenario.pings.count < 2) return;
  std::vector<TomlTable> transmitters = root.one_or_more("transmitter");
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const double interval = scenario.transmitters[t].interval.value_or(scenario.pings.interval),
                 duration = Pulse(pulse_of(scenario, static_cast<int>(t))).duration();
    if (interval >= duration) continue;
    const TomlTable pings = root.table("pings");
    const TomlTable& table = scenario.transmitters[t].interval ? transmitters[t] : pings;
    throw table.fault("interval",
                      "an interval of at least the pulse's duration, " + to_text(duration) +
                          " s: a projector sends one pulse at a time",
                      to_text(interval) + " s");
  }
}

}  // namespace asdic::detail::scenario
