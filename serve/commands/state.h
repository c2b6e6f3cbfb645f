#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Tells where everything is.
struct StateCommand {
  static constexpr std::string_view name = "state";
  static constexpr bool light = true;
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
