#pragma once
#include <optional>
#include <string>

#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Calls off commands that were sent before it. Connections carry it out as soon as it is read, so
/// that it overtakes them; a session by itself, whose commands come one by one, has nothing to.
struct CancelCommand {
  static constexpr std::string_view name = "cancel";
  static constexpr bool light = true;
  static Answer run(SessionState& session, const Command& command);

  /// The id of those that are meant, JSON; none: all of them. \throws Refusal ("value")
  [[nodiscard]] static std::optional<std::string> meant(const Command& command);
  /// \param number  of commands that were called off
  [[nodiscard]] static Answer answer(const Command& command, std::size_t number);
};

}  // namespace asdic::detail::serve
