#pragma once
#include <array>
#include <span>

#include "serve/commands/arrivals.h"
#include "serve/commands/cancel.h"
#include "serve/commands/field.h"
#include "serve/commands/levels.h"
#include "serve/commands/limits.h"
#include "serve/commands/listen.h"
#include "serve/commands/ping.h"
#include "serve/commands/quit.h"
#include "serve/commands/rays.h"
#include "serve/commands/save.h"
#include "serve/commands/state.h"
#include "serve/commands/update.h"

namespace asdic::detail::serve {

template <ServeCommand... C>
inline constexpr std::array<AnyCommand, sizeof...(C)> command_list{any_command<C>()...};

/// Every command. A new one is one file and one name here.
inline constexpr std::span<const AnyCommand> all_commands =
    command_list<PingCommand, UpdateCommand, ListenCommand, StateCommand, LimitsCommand,
                 ArrivalsCommand, RaysCommand, FieldCommand, LevelsCommand, SaveCommand,
                 CancelCommand, QuitCommand>;

}  // namespace asdic::detail::serve
