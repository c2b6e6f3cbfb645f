#include "serve/commands/update.h"

#include "serve/answers.h"

namespace asdic::detail::serve {

Answer UpdateCommand::run(SessionState& session, const Command& command) {
  session.live.update(command.fields, session.now());
  return {.line = update_line(command.id, session.live.state().scenario, session.now(),
                              session.clock() - command.received)};
}

}  // namespace asdic::detail::serve
