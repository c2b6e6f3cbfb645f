#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Ends the session.
struct QuitCommand {
  static constexpr std::string_view name = "quit";
  static constexpr bool light = true;
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
