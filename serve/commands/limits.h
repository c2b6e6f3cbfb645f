#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Tells what a client may ask for.
struct LimitsCommand {
  static constexpr std::string_view name = "limits";
  static constexpr bool light = true;
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
