#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Changes the scenario from here on.
struct UpdateCommand {
  static constexpr std::string_view name = "update";
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
