#include "serve/prepared_ping.h"

#include <algorithm>

#include "core/text.h"
#include "serve/places.h"
#include "serve/refusal.h"

namespace asdic::detail::serve {

Transmission transmission_of(const SessionState& session, const PingRequest& request) {
  const Scenario& scenario = session.live.state().scenario;
  Transmission sent = request.transmitter ? session.schedule.next(scenario, *request.transmitter)
                                          : session.schedule.next(scenario);
  if (request.time)
    sent.time = *request.time;
  else if (session.acts)
    sent.time = *session.acts;
  if (request.elevation) {
    const AnyBeam& beam = scenario.transmitters[static_cast<std::size_t>(sent.transmitter)].beam;
    if (!steers(beam))
      throw Refusal("value",
                    refusal_text("elevation_deg", to_text(degrees(*request.elevation)),
                                 "none for a transmitter with a " + std::string(name_of(beam))));
    sent.elevation = *request.elevation;
  }
  return sent;
}

PreparedPing prepare_ping(SessionState& session, const Command& command, Delivery usual) {
  const SessionSettings& settings = session.settings;
  const double begin = session.clock();
  PreparedPing ping{.request = read_ping(command.fields, session.live, settings.limits, usual),
                    .number = session.pings + 1,
                    .due = command.received};
  ping.sent = transmission_of(session, ping.request);
  ping.request.changes.transmitter = ping.sent.transmitter;
  ping.served.id = command.id;
  if (settings.pace.by_the_clock()) {
    const double wanted = session.start + ping.sent.time / *settings.pace.factor;
    if (wanted > begin + double(settings.limits.idle_seconds))
      throw Refusal("limit", refusal_text("time", to_text(ping.sent.time) + " s",
                                          "a ping at most idle_seconds ahead of the clock"));
    ping.served.behind = std::max(0.0, begin - wanted);
    ping.due = std::max(ping.due, wanted);
  }
  ping.simulator = session.simulator_of(session.live.with(ping.request.changes, command.fields));
  check_places(ping.simulator->scenario(), ping.number, ping.sent.transmitter, ping.sent.time);
  if (ping.sent.time < session.live.changed())
    ping.served.warnings.push_back(
        "time: " + to_text(ping.sent.time) + " s lies before the latest change, at " +
        to_text(session.live.changed()) + " s: all is as that says, back in time");
  ping.served.prepare = session.clock() - begin;
  return ping;
}

}  // namespace asdic::detail::serve
