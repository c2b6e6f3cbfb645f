#include "serve/commands/limits.h"

#include "serve/answers.h"

namespace asdic::detail::serve {

Answer LimitsCommand::run(SessionState& session, const Command& command) {
  refuse_further_keys(command);
  return {.line = limits_line(command.id, session.settings.limits)};
}

}  // namespace asdic::detail::serve
