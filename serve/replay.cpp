#include "serve/replay.h"

#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "io/files/input_file.h"
#include "serve/answers.h"
#include "serve/hand_out.h"
#include "serve/line_splitter.h"
#include "serve/sent_ping.h"
#include "serve/session.h"

namespace asdic::detail::serve {
namespace {

using LogJson = nlohmann::ordered_json;
using Tell = std::function<void(const Answer&)>;

/// A line that is not as it should be.
struct Wrong {
  std::string got, expected = "what --log has written";
};

/// Longest line of a log [bytes]: a client's longest line with every number written out, and times.
std::size_t longest_line(const SessionSettings& settings) {
  constexpr std::size_t longer = 8, times = 4096;
  return longer * settings.limits.line_bytes + CommandLog::first_line(settings).size() + times;
}

bool is_whole(const LogJson& entry, const char* key) {
  return entry.contains(key) && entry[key].is_number_integer();
}

class Replay {
 public:
  Replay(const SessionSettings& settings, Tell tell)
      : settings_(settings), tell_(std::move(tell)) {}

  void first_line(const LogJson& entry) const {
    const LogJson own = LogJson::parse(CommandLog::first_line(settings_));
    if (entry.value("asdic_log", LogJson()) != own["asdic_log"])
      throw Wrong{"another first line", "a log of commands that --log has written"};
    for (const char* same : {"scenario", "overrides"})
      if (entry.value(same, LogJson()) != own[same])
        throw Wrong{std::string("a log of another scenario (") + same + ")",
                    "the scenario and the --set of the server that wrote it"};
  }

  void line(const LogJson& entry) {
    if (!is_whole(entry, "session")) throw Wrong{"another line"};
    if (entry.contains("command")) {
      if (!entry.contains("ok") || !entry["ok"].is_boolean()) throw Wrong{"another line"};
      if (entry["ok"] == true) command(session_of(entry), entry);
      return;
    }
    Session& session = session_of(entry);
    if (!session.state().listening) throw Wrong{"a line of a session that has not listened"};
    hear(session, entry);
    if (is_whole(entry, "scheduled"))
      scheduled(session, entry);
    else if (entry.value("listening", LogJson()) == false)
      session.state().end_listening();
    else
      throw Wrong{"another line"};
  }

  /// What was listened to for some seconds is heard to their end, if nothing says that it was not.
  void rest() {
    for (const auto& [number, session] : sessions_) {
      SessionState& state = session->state();
      if (!state.listening) continue;
      const auto blocks = state.listening->blocks();
      if (blocks && blocks->end) hand_out(state);
    }
  }

  [[nodiscard]] std::size_t refused() const noexcept { return refused_; }

 private:
  static double clock() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
  }

  Session& session_of(const LogJson& entry) {
    std::unique_ptr<Session>& session = sessions_[entry["session"].get<int>()];
    if (!session) {
      session = std::make_unique<Session>(settings_, clock);
      session->state().replayed = true;
      session->state().tell = [this](const Answer& answer) { tell_(answer); };
      tell_(session->greeting());
    }
    return *session;
  }

  /// As far as the session was heard before what the line tells.
  static void hear(Session& session, const LogJson& entry) {
    if (!is_whole(entry, "heard"))
      throw Wrong{"no heard", "how far a session that listens was heard"};
    const auto until = entry["heard"].get<std::int64_t>();
    SessionState& state = session.state();
    hand_out(state, until);
    if (state.listening->position() != until)
      throw Wrong{"heard: " + std::to_string(until),
                  std::to_string(state.listening->position()) + ", as far as it is heard here"};
  }

  void command(Session& session, const LogJson& entry) {
    SessionState& state = session.state();
    if (state.listening) hear(session, entry);
    Command command;
    try {
      command = read_command(entry["command"].dump(), settings_.limits);
    } catch (const Refusal& refusal) {
      throw Wrong{refusal.what(), "a command that had been carried out"};
    }
    command.received = clock();
    if (const auto acts = entry.find("acts"); acts != entry.end() && acts->is_number())
      command.acts = acts->get<double>();
    const bool listened = state.listening && state.listening->blocks();
    const Answer answer = session.execute(command);
    if (answer.refused) ++refused_;
    tell_(answer);
    if (listened && !state.listening->blocks())
      tell_({.line = listening_ended_line(state.listening->time())});
  }

  static void scheduled(Session& session, const LogJson& entry) {
    SessionState& state = session.state();
    if (entry["scheduled"].get<int>() != state.pings + 1)
      throw Wrong{"scheduled: " + entry["scheduled"].dump(),
                  std::to_string(state.pings + 1) + ", the next ping here"};
    send_scheduled_ping(state);
  }

  const SessionSettings& settings_;
  Tell tell_;
  std::map<int, std::unique_ptr<Session>> sessions_;
  std::size_t refused_ = 0;
};

}  // namespace

std::size_t replay(const SessionSettings& settings, const std::filesystem::path& log,
                   const std::function<void(const Answer&)>& tell) {
  const auto wrong = [&](std::size_t number, const Wrong& what) {
    return InputError(
        {.where = "--replay " + log.string() + (number == 0 ? "" : ":" + std::to_string(number)),
         .got = what.got,
         .expected = what.expected});
  };
  InputFile file(log, "a log of commands that --log has written");
  Replay again(settings, tell);
  std::size_t number = 0;
  LineSplitter lines(longest_line(settings));
  const auto take = [&](const LineSplitter::Line& line) {
    ++number;
    const LogJson entry = LogJson::parse(line.text, nullptr, false);
    try {
      if (line.too_long || !entry.is_object()) throw Wrong{"another line"};
      if (number == 1)
        again.first_line(entry);
      else
        again.line(entry);
    } catch (const Wrong& what) {
      throw wrong(number, what);
    }
  };
  constexpr std::size_t piece = 65536;
  for (std::string bytes = file.read(piece); !bytes.empty(); bytes = file.read(piece))
    for (std::string_view rest = bytes; !rest.empty();)  // a last line may be torn: it is left out
      if (const auto line = lines.take(rest)) take(*line);
  if (number == 0) throw wrong(0, {"an empty file"});
  again.rest();
  return again.refused();
}

}  // namespace asdic::detail::serve
