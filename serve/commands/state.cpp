#include "serve/commands/state.h"

#include "serve/answers.h"

namespace asdic::detail::serve {

Answer StateCommand::run(SessionState& session, const Command& command) {
  refuse_further_keys(command);
  return {.line = state_line(command.id, session.live.state().scenario, session.now(),
                             session.pings + 1, session.latency)};
}

}  // namespace asdic::detail::serve
