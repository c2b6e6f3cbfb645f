#pragma once
#include <cstdint>
#include <limits>

#include "serve/session_state.h"

namespace asdic::detail::serve {

/// Hands out what is heard in blocks up to a sample, at once: until it is over if that comes
/// before. Sends the pings of the schedule that are wanted, but in a replay, whose log has them.
/// \throws InputError, what telling it throws
void hand_out(SessionState& session, std::int64_t until = std::numeric_limits<std::int64_t>::max());

}  // namespace asdic::detail::serve
