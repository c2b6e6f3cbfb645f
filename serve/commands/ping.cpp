#include "serve/commands/ping.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "raytrace/parallel/stop.h"
#include "serve/answers.h"
#include "serve/prepared_ping.h"
#include "serve/refusal.h"
#include "serve/sent_ping.h"
#include "sonar/ping/levels.h"
#include "sonar/ping/recorded_replica.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::serve {
namespace {

constexpr std::size_t table_bytes = 1 << 20;  // of a file beside its samples, about

/// Its sound comes in blocks.
Answer ping_into_stream(SessionState& session, const Command& command) {
  PingRequest request =
      read_ping(command.fields, session.live, session.settings.limits, Delivery::none);
  if (request.deliver != Delivery::none)
    throw Refusal("value",
                  refusal_text("deliver", in_quotes(delivery_words[std::size_t(request.deliver)]),
                               "\"none\" in a session that listens: its sound comes in blocks"));
  const Transmission sent = transmission_of(session, request);
  request.changes.transmitter = sent.transmitter;
  return send_into_stream(session, command, request, sent);
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
  if (session.listening) return ping_into_stream(session, command);
  if (session.live.state().scenario.pings.continuous)
    throw Refusal("value",
                  refusal_text("ping", "a scenario with pings.continuous", "\"listen\" before it"));
  PreparedPing ping =
      prepare_ping(session, command, settings.output.empty() ? Delivery::none : Delivery::file);
  const PingRequest& request = ping.request;
  const Transmission& sent = ping.sent;
  ServedPing& served = ping.served;
  const Scenario& scenario = ping.simulator->scenario();
  const Recording recording = recording_of(scenario);
  const double bytes = double(channels_of(scenario)) * double(recording.samples) *
                       double(recording.components() * sizeof(float));
  if (request.deliver == Delivery::samples && bytes > double(settings.limits.answer_bytes))
    throw Refusal("limit", refusal_text("deliver", "more samples",
                                        "at most " + std::to_string(settings.limits.answer_bytes) +
                                            " bytes in an answer"));
  if (request.deliver == Delivery::samples) session.make_room(static_cast<std::size_t>(bytes));
  std::optional<CountedFile> file;
  if (request.deliver == Delivery::file) {
    served.file = session.next_file().string();
    file.emplace(*settings.written, settings.limits.output_bytes, served.file,
                 static_cast<std::size_t>(bytes) + table_bytes);
  }
  PingRecord record = ping.simulator->simulate(ping.number, sent);
  stop_point();  // the last: what follows is done as a whole
  if (request.deliver == Delivery::file) {
    const double start = session.clock();
    Scenario told = scenario;
    if (request.elevation)
      told.overrides.push_back(session.live.elevation_override(sent.transmitter, sent.elevation));
    PingFileWriter writer(served.file, told, settings.provenance);
    writer.append(record);
    writer.finish(true);
    file->keep();
    record.timings.write = session.clock() - start;
  }
  if (const double apart = std::abs(sent.time - session.latest_ping);
      request.deliver != Delivery::none && apart < end_of_record(scenario))
    served.warnings.push_back("time: another ping was sent " + to_text(apart) +
                              " s from this one, less than a record: neither record has what is "
                              "received of the other; \"listen\" has both");
  if (std::string beside =
          echo_beside_record(record, scenario, ping.simulator->pulse(sent.transmitter));
      !beside.empty())
    served.warnings.push_back(std::move(beside));
  ++session.pings;
  session.latest_ping = std::max(session.latest_ping, sent.time);
  session.schedule.sent(sent, request.time || session.acts);
  served.with_samples = request.deliver == Delivery::samples;
  served.latency = session.clock() - ping.due;
  session.latency.add(served.latency);
  std::vector<float> pulse;
  if (request.replica) pulse = recorded_replica(scenario, sent.transmitter);
  served.replica = pulse.size();
  Answer answer{.line = ping_line(served, record, scenario)};
  if (served.with_samples) answer.samples = std::move(record.pressure);
  answer.samples.reserve(answer.samples.size() + pulse.size());  // and no more
  answer.samples.insert(answer.samples.end(), pulse.begin(), pulse.end());
  return answer;
}

}  // namespace asdic::detail::serve
