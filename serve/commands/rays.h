#pragma once
#include "serve/commands/command_list.h"

namespace asdic::detail::serve {

/// Traces a fan of rays: as `asdic rays`.
struct RaysCommand {
  static constexpr std::string_view name = "rays";
  static Answer run(SessionState& session, const Command& command);
};

}  // namespace asdic::detail::serve
