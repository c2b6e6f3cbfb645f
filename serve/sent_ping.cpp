#include "serve/sent_ping.h"

#include <algorithm>

#include "core/text.h"
#include "serve/answers.h"
#include "serve/refusal.h"
#include "sonar/ping/recorded_replica.h"

namespace asdic::detail::serve {
namespace {

/// A ping and its answer. \param moved  its time is not the schedule's
Answer send(SessionState& session, ServedPing served, const Transmission& sent,
            const LiveScenario::State& state, double due, bool moved, bool with_replica) {
  Listening& listening = *session.listening;
  const int number = session.pings + 1;
  const PingRecord record = listening.send(session, number, sent, state);
  ++session.pings;
  session.latest_ping = std::max(session.latest_ping, sent.time);
  session.schedule.sent(sent, moved);
  // The next one may be earlier than it was: what is heard waits for it.
  listening.scheduled_until(session.schedule.next(session.live.state().scenario).time);
  session.live.forget_before(session.heard->oldest - tow_memory(state.scenario));
  served.latency = std::max(0.0, session.clock() - due);
  session.latency.add(served.latency);
  std::vector<float> pulse;
  if (with_replica) pulse = recorded_replica(state.scenario, sent.transmitter);
  served.replica = pulse.size();
  return {.line = ping_line(served, record, state.scenario), .samples = std::move(pulse)};
}

}  // namespace

Answer send_into_stream(SessionState& session, const Command& command, const PingRequest& request,
                        Transmission sent) {
  Listening& listening = *session.listening;
  const SessionSettings& settings = session.settings;
  const double begin = session.clock();
  ServedPing served{.id = command.id};
  const double heard = session.heard->time;
  const bool by_the_clock = settings.pace.by_the_clock();
  // Whoever listens pings now, whatever the schedule has.
  if (!request.time)
    sent.time =
        std::max(heard, session.acts.value_or(by_the_clock ? session.at(command.received) : heard));
  sent.time = listening.whole_samples(sent.time);
  if (sent.time < heard) {
    if (request.time && *request.time < heard)
      throw Refusal("value", refusal_text("time", to_text(*request.time) + " s",
                                          "at least " + to_text(heard) +
                                              " s: what is received before was handed out"));
    sent.time = heard;
  }
  double due = command.received;
  if (by_the_clock) {
    const double wanted = session.clock_at(sent.time);
    if (wanted > begin + double(settings.limits.idle_seconds))
      throw Refusal("limit", refusal_text("time", to_text(sent.time) + " s",
                                          "a ping at most idle_seconds ahead of the clock"));
    served.behind = std::max(0.0, begin - wanted);
    due = std::max(due, wanted);
  }
  const LiveScenario::State state = session.live.with(request.changes, command.fields);
  served.prepare = session.clock() - begin;
  return send(session, std::move(served), sent, state, due, true, request.replica);
}

void send_scheduled_ping(SessionState& session) {
  Transmission sent = session.schedule.next(session.live.state().scenario);
  session.heard = session.listening->heard();
  sent.time = session.listening->whole_samples(sent.time);
  const bool late = sent.time < session.heard->time;  // it began before anybody listened
  if (late) sent.time = session.heard->time;
  const double due = session.settings.pace.by_the_clock()
                         ? std::max(session.clock(), session.clock_at(sent.time))
                         : session.clock();
  Answer told = send(session, {.scheduled = true}, sent, session.live.state(), due, late, false);
  if (session.settings.log)
    session.settings.log->scheduled(session.number, session.heard->position, session.pings);
  session.tell(std::move(told));
}

void send_scheduled(SessionState& session, double before) {
  for (;;) {
    const Transmission sent = session.schedule.next(session.live.state().scenario);
    if (sent.time >= before) {
      session.listening->scheduled_until(sent.time);
      return;
    }
    send_scheduled_ping(session);
  }
}

}  // namespace asdic::detail::serve
