#include "serve/commands/listen.h"

#include <cmath>

#include "core/text.h"
#include "serve/answers.h"
#include "serve/hand_out.h"
#include "serve/listen_request.h"
#include "serve/refusal.h"
#include "serve/stream/block_sink.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::serve {
namespace {

/// As fast as the client takes it, within the command.
void hand_out_now(SessionState& session) {
  try {
    hand_out(session);
  } catch (...) {
    session.end_listening();
    throw;
  }
}

/// Where the samples go; none: to the client. \throws Refusal
std::shared_ptr<BlockSink> sink_of(const SessionState& session, const ListenRequest& request,
                                   std::size_t samples) {
  if (request.deliver == BlockDelivery::samples || session.replayed) return nullptr;
  const std::string word =
      in_quotes(words(request.deliver)[static_cast<std::size_t>(request.deliver)]);
  BlockOutlet* const outlet = request.deliver == BlockDelivery::udp ? session.settings.udp.get()
                                                                    : session.settings.ring.get();
  if (outlet == nullptr)
    throw Refusal(
        "value",
        refusal_text("deliver", word,
                     "\"samples\": the server has no --" +
                         std::string(words(request.deliver)[std::size_t(request.deliver)])));
  const Scenario& scenario = session.live.state().scenario;
  const BlockShape shape{.channels = channels_of(scenario),
                         .samples = samples,
                         .components = recording_of(scenario).components()};
  const auto most = [&](const std::string& where, std::size_t got, const char* unit,
                        std::size_t limit) {
    if (got > limit)
      throw Refusal("limit", refusal_text(where, std::to_string(got) + unit,
                                          "at most " + std::to_string(limit) + unit +
                                              " with \"deliver\": " + word));
  };
  most("deliver", shape.channels, " phones", outlet->most_channels());
  most("block", shape.bytes(), " bytes", outlet->longest_block());
  auto sink = outlet->open(shape);
  if (!sink)
    throw Refusal("value", refusal_text("deliver", word + ", which another session's stream has",
                                        "one stream at a time"));
  return sink;
}

}  // namespace

Answer ListenCommand::run(SessionState& session, const Command& command) {
  const ListenRequest request = read_listen(command.fields);
  const bool goes_on = session.settings.pace.by_the_clock() || session.replayed;
  if (request.stop) {
    if (!session.listening)
      throw Refusal("value", refusal_text("stop", "nobody that listens", "listen before"));
    session.listening->end();
    return {.line = listen_line(command.id, session.live.state().scenario,
                                session.listening->time(), 0)};
  }
  if (!goes_on && !request.seconds)
    throw Refusal("value",
                  refusal_text("seconds", "none", "how long, with --pace fast: there is no clock"));
  if (session.listening && session.listening->blocks())
    throw Refusal("value", refusal_text("listen", "a session that listens", "\"stop\" before it"));
  const double now = session.now();
  if (!session.listening) {
    session.live.listen(0.0);
    session.listening = std::make_unique<Listening>(session.simulator_of(session.live.state()),
                                                    session.live.state().changes, now);
  }
  Listening& listening = *session.listening;
  const double rate = listening.rate();
  Listening::Blocks blocks{.samples = std::max<std::int64_t>(1, std::llround(request.block * rate)),
                           .scheduled = request.schedule};
  if (blocks.samples > static_cast<std::int64_t>(session.settings.limits.samples))
    throw Refusal("limit",
                  refusal_text("block", std::to_string(blocks.samples) + " samples",
                               "at most " + std::to_string(session.settings.limits.samples)));
  if (request.seconds) blocks.end = std::llround(*request.seconds * rate);
  blocks.sink = sink_of(session, request, static_cast<std::size_t>(blocks.samples));
  listening.begin(blocks, now);
  Answer answer{.line = listen_line(command.id, session.live.state().scenario, listening.time(),
                                    blocks.samples)};
  if (!goes_on) answer.then = [&session] { hand_out_now(session); };
  return answer;
}

}  // namespace asdic::detail::serve
