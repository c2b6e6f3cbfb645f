#pragma once
#include "serve/answers.h"
#include "serve/command.h"
#include "serve/ping_request.h"
#include "serve/session_state.h"

namespace asdic::detail::serve {

/// A ping that can be made: all that the command and the session say is known and allowed.
struct PreparedPing {
  PingRequest request;
  Transmission sent;
  int number = 1;
  std::shared_ptr<const PingSimulator> simulator = nullptr;
  double due = 0.0;     ///< when it was to be sent, on the clock [s]
  ServedPing served{};  ///< what is known of it by now
};

/// Whose turn it is, when and how. \throws Refusal
[[nodiscard]] Transmission transmission_of(const SessionState& session, const PingRequest& request);

/// \param usual  where its samples go, where the command does not say \throws Refusal, InputError
[[nodiscard]] PreparedPing prepare_ping(SessionState& session, const Command& command,
                                        Delivery usual);

}  // namespace asdic::detail::serve
