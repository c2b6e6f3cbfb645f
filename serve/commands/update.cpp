#include "serve/commands/update.h"

#include <algorithm>

#include "core/text.h"
#include "serve/answers.h"

namespace asdic::detail::serve {

namespace {

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
  const double now = session.now(), changed = session.live.changed();
  session.live.update(command.fields, now);
  const std::optional<double> said = number_said(command.fields, "time");
  std::optional<double> behind;
  if (session.settings.pace.by_the_clock()) behind = std::max(0.0, now - said.value_or(now));
  std::vector<std::string> warnings;
  if (said) warnings = told_of_past(*said, changed, session.latest_ping);
  return {.line = update_line(command.id, session.live.state().scenario, session.now(),
                              session.clock() - command.received, behind, warnings)};
}

}  // namespace asdic::detail::serve
