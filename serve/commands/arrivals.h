#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Tells every eigenray to the targets and back, or to a receiver anywhere: as `asdic arrivals`.
struct ArrivalsCommand {
  static constexpr std::string_view name = "arrivals";
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
