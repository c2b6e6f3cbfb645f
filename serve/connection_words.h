#pragma once
#include <string>

#include "serve/command.h"
#include "serve/refusal.h"
#include "serve/session.h"

// What a connection says by itself, without its session.
namespace asdic::detail::serve {

/// The handshake of a first line. \param token  that it must have; empty: none
/// \throws Refusal ("handshake", "token")
[[nodiscard]] Handshake checked_handshake(const std::string& line, const std::string& token);

[[nodiscard]] Answer line_too_long(const SessionLimits& limits);
[[nodiscard]] Answer queue_full(const std::string& id, const SessionLimits& limits);
[[nodiscard]] Answer command_cancelled(const std::string& id);
[[nodiscard]] Answer command_too_long(const std::string& id, const SessionLimits& limits);
[[nodiscard]] Answer client_too_long(const std::string& id, const SessionLimits& limits);
/// Of all clients together.
[[nodiscard]] Refusal answers_wait(const SessionLimits& limits);
[[nodiscard]] Answer no_place(const SessionLimits& limits);
[[nodiscard]] Answer handshake_too_late(const SessionLimits& limits);
[[nodiscard]] Answer idle_too_long(const SessionLimits& limits);

}  // namespace asdic::detail::serve
