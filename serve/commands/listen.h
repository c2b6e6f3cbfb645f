#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Hands out what all phones receive, block by block, from now on.
struct ListenCommand {
  static constexpr std::string_view name = "listen";
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
