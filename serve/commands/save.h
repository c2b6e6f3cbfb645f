#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Gives the scenario as it is by now as a TOML file, whose ping of the next one's number is the
/// next one, bit for bit.
struct SaveCommand {
  static constexpr std::string_view name = "save";
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
