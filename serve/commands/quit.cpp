#include "serve/commands/quit.h"

#include "serve/answers.h"

namespace asdic::detail::serve {

Answer QuitCommand::run(SessionState& session, const Command& command) {
  refuse_further_keys(command);
  return {.line = quit_line(command.id, session.pings, session.latency), .last = true};
}

}  // namespace asdic::detail::serve
