#include "serve/commands/ping.h"

#include <algorithm>

#include "core/text.h"
#include "serve/answers.h"
#include "serve/ping_request.h"
#include "serve/places.h"
#include "serve/refusal.h"
#include "serve/sent_ping.h"
#include "sonar/ping/recorded_replica.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::serve {
namespace {

Transmission transmission_of(const SessionState& session, const PingRequest& request) {
  const Scenario& scenario = session.live.state().scenario;
  Transmission sent = request.transmitter ? session.schedule.next(scenario, *request.transmitter)
                                          : session.schedule.next(scenario);
  if (request.time)
    sent.time = *request.time;
  else if (session.settings.pace.by_the_clock())
    sent.time = session.now();
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

}  // namespace

double PingCommand::wait(const SessionState& session, const Command& command) {
  if (!session.settings.pace.by_the_clock() || session.listening) return 0.0;
  const auto wanted = number_said(command.fields, "time");
  if (!wanted) return 0.0;  // a wrong one is told when the command is carried out
  const double ahead = std::max(0.0, (*wanted - session.now()) / *session.settings.pace.factor);
  return ahead > double(session.settings.limits.idle_seconds) ? 0.0 : ahead;  // it is refused
}

Answer PingCommand::run(SessionState& session, const Command& command) {
  const SessionSettings& settings = session.settings;
  const double begin = session.clock();
  const Delivery usual =
      settings.output.empty() || session.listening ? Delivery::none : Delivery::file;
  PingRequest request = read_ping(command.fields, session.live, settings.limits, usual);
  const Transmission sent = transmission_of(session, request);
  request.changes.transmitter = sent.transmitter;
  if (session.listening) {
    if (request.deliver != Delivery::none)
      throw Refusal(
          "value",
          refusal_text("deliver", in_quotes(words(request.deliver)[std::size_t(request.deliver)]),
                       "\"none\" in a session that listens: its sound comes in blocks"));
    return send_into_stream(session, command, request, sent);
  }
  if (session.live.state().scenario.pings.continuous)
    throw Refusal("value",
                  refusal_text("ping", "a scenario with pings.continuous", "\"listen\" before it"));
  ServedPing served{.id = command.id};
  double due = command.received;  // when it was to be sent, on the clock
  if (settings.pace.by_the_clock()) {
    const double wanted = session.start + sent.time / *settings.pace.factor;
    if (wanted > begin + double(settings.limits.idle_seconds))
      throw Refusal("limit", refusal_text("time", to_text(sent.time) + " s",
                                          "a ping at most idle_seconds ahead of the clock"));
    served.behind = std::max(0.0, begin - wanted);
    due = std::max(due, wanted);
  }
  const auto simulator = session.simulator_of(session.live.with(request.changes, command.fields));
  const Scenario& scenario = simulator->scenario();
  const int number = session.pings + 1;
  check_places(scenario, number, sent.transmitter, sent.time);
  const double bytes = double(channels_of(scenario)) * double(recording_of(scenario).samples) * 8.0;
  if (request.deliver == Delivery::samples && bytes > double(settings.limits.answer_bytes))
    throw Refusal("limit", refusal_text("deliver", "more samples",
                                        "at most " + std::to_string(settings.limits.answer_bytes) +
                                            " bytes in an answer"));
  if (sent.time < session.live.changed())
    served.warning = "time: " + to_text(sent.time) + " s lies before the latest change, at " +
                     to_text(session.live.changed()) + " s: all is as that says, back in time";
  served.prepare = session.clock() - begin;
  PingRecord record = simulator->simulate(number, sent);
  if (request.deliver == Delivery::file) {
    const double start = session.clock();
    served.file = session.next_file().string();
    Scenario told = scenario;
    if (request.elevation)
      told.overrides.push_back(session.live.elevation_override(sent.transmitter, sent.elevation));
    PingFileWriter writer(served.file, told, settings.provenance);
    writer.append(record);
    writer.finish(true);
    record.timings.write = session.clock() - start;
  }
  ++session.pings;
  session.schedule.sent(sent, request.time || settings.pace.by_the_clock());
  served.with_samples = request.deliver == Delivery::samples;
  served.latency = session.clock() - due;
  session.latency.add(served.latency);
  std::vector<float> pulse;
  if (request.replica) pulse = recorded_replica(scenario, sent.transmitter);
  served.replica = pulse.size();
  Answer answer{.line = ping_line(served, record, scenario)};
  if (served.with_samples) answer.samples = std::move(record.pressure);
  answer.samples.insert(answer.samples.end(), pulse.begin(), pulse.end());
  return answer;
}

}  // namespace asdic::detail::serve
