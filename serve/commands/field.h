#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Computes a pressure field: as `asdic field`.
struct FieldCommand {
  static constexpr std::string_view name = "field";
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
