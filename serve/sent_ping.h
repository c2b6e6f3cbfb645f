#pragma once
#include "serve/command.h"
#include "serve/ping_request.h"
#include "serve/session_state.h"

namespace asdic::detail::serve {

/// Sends a ping into what a session hears. \return what is known of it; its sound comes in blocks
/// \throws Refusal, InputError
[[nodiscard]] Answer send_into_stream(SessionState& session, const Command& command,
                                      const PingRequest& request, Transmission sent);

/// Sends the next ping of the schedule, and tells what is known of it.
void send_scheduled_ping(SessionState& session);

/// The same for all pings of the schedule that are due before a time, and were not sent.
void send_scheduled(SessionState& session, double before);

}  // namespace asdic::detail::serve
