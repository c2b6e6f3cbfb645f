#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Sends a ping, and tells what comes back.
struct PingCommand {
  static constexpr std::string_view name = "ping";
  static Answer run(SessionState& session, const Command& command);
  /// By the clock, until its time.
  static double wait(const SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
