#pragma once
#include <string>
#include <string_view>

#include "io/text/toml_value.h"
#include "serve/session_limits.h"

namespace asdic::serve {

enum class CommandKind { ping, update, state, limits, quit };

/// One line of a client: what it wants, and the values that come with it.
struct Command {
  CommandKind kind = CommandKind::state;
  std::string id = "null";  ///< JSON, echoed in the answer
  TomlValue fields;         ///< a table of all keys but "command" and "id"
  double received = 0.0;    ///< on the server's clock [s]
};

/// What the first line of a connection says.
struct Handshake {
  std::string token;
  bool waits = false;  ///< when the queue is full, reading stops; else commands are answered "busy"
};

/// Reads a command (docs/formats/serve.md). Nesting is counted while it is read, a key may stand
/// once, numbers are finite, text is UTF-8.
/// \throws Refusal ("json", "limit", "command")
[[nodiscard]] Command read_command(std::string_view line, const SessionLimits& limits);

/// \throws Refusal ("handshake") whose message says nothing of the line
[[nodiscard]] Handshake read_handshake(std::string_view line);

/// The id of a line that is no command, however far it can be read; "null" if it has none up to
/// there, or two.
[[nodiscard]] std::string id_of(std::string_view line, const SessionLimits& limits);

[[nodiscard]] std::string_view name_of(CommandKind kind);

}  // namespace asdic::serve
