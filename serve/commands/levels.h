#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Tells the levels that the next ping would have, over time. Nothing is sent.
struct LevelsCommand {
  static constexpr std::string_view name = "levels";
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
