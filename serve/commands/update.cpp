#include "serve/commands/update.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/text.h"
#include "serve/answers.h"
#include "serve/motion.h"
#include "serve/refusal.h"

namespace asdic::detail::serve {

namespace {

/// Whether targets or the sea become of another kind, and not only move.
bool strikes(const TomlValue& fields) {
  if (fields.find("wind_speed") != nullptr) return true;
  const TomlValue* targets = fields.find("targets");
  if (targets == nullptr) return false;
  const auto otherwise = [](const TomlValue& one) {
    const auto* table = std::get_if<TomlValue::Table>(&one.data);
    return table != nullptr && std::any_of(table->begin(), table->end(), [](const auto& entry) {
             return entry.key != "name" && std::find(motion_keys.begin(), motion_keys.end(),
                                                     entry.key) == motion_keys.end();
           });
  };
  if (const auto* several = std::get_if<TomlValue::Array>(&targets->data))
    return std::any_of(several->begin(), several->end(), otherwise);
  return otherwise(*targets);
}

/// Of what is heard from a time on; all of it, or nothing.
Answer update_stream(SessionState& session, const Command& command) {
  Listening& listening = *session.listening;
  const double heard = session.heard->time;
  const std::optional<double> said = number_said(command.fields, "time");
  const auto refuse = [&](double least, const char* why) {
    throw Refusal("value",
                  refusal_text("time", to_text(*said) + " s", "at least " + to_text(least) + why));
  };
  if (said && *said < heard) refuse(heard, " s: what is received before was handed out");
  if (said && *said < session.live.changed())
    refuse(session.live.changed(), " s, of the latest change");
  double time = heard;
  if (said)
    time = *said;
  else if (session.acts)
    time = std::max(heard, *session.acts);
  time = std::max(time, session.live.changed());
  const LiveScenario before = session.live;
  const std::size_t targets = before.state().scenario.targets.size();
  const auto answer = [&](bool drawn_anew) -> Answer {
    return {.line = update_line(command.id, session.live.state().scenario, time,
                                session.clock() - command.received, {}, {}, drawn_anew)};
  };
  if (!session.live.update(command.fields, time)) return answer(false);
  try {
    listening.change(
        session, time,
        strikes(command.fields) || session.live.state().scenario.targets.size() != targets);
  } catch (...) {
    session.live = before;
    throw;
  }
  session.live.forget_before(session.heard->oldest - tow_memory(before.state().scenario));
  // Streams of reverberation are known by their Doppler factors, which another course changes.
  const bool drawn_anew = command.fields.find("platform") != nullptr &&
                          before.state().scenario.reverberation.enabled && listening.sounds();
  return answer(drawn_anew);
}

/// What a time in the past does not do.
std::vector<std::string> told_of_past(double time, double changed, double latest_ping) {
  std::vector<std::string> told;
  const std::string said = "time: " + to_text(time) + " s lies before the latest ";
  if (time < changed)
    told.push_back(said + "change, at " + to_text(changed) +
                   " s: what this one moves goes on from there, all else stays as changed");
  if (time < latest_ping)
    told.push_back(said + "ping, at " + to_text(latest_ping) +
                   " s: what that received stays as it was");
  return told;
}

}  // namespace

Answer UpdateCommand::run(SessionState& session, const Command& command) {
  if (session.listening) return update_stream(session, command);
  const double now = session.now(), changed = session.live.changed();
  static_cast<void>(session.live.update(command.fields, now));
  const std::optional<double> said = number_said(command.fields, "time");
  std::optional<double> behind;
  if (session.settings.pace.by_the_clock()) behind = std::max(0.0, now - said.value_or(now));
  std::vector<std::string> warnings;
  if (said) warnings = told_of_past(*said, changed, session.latest_ping);
  return {.line = update_line(command.id, session.live.state().scenario, session.now(),
                              session.clock() - command.received, behind, warnings)};
}

}  // namespace asdic::detail::serve
