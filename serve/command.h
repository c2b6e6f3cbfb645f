#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/text/toml_value.h"
#include "serve/session_limits.h"

namespace asdic::detail::serve {

/// One line of a client: what it wants, and the values that come with it.
struct Command {
  std::string_view name;            ///< one of those that it was read with
  std::string id = "null";          ///< JSON, echoed in the answer
  TomlValue fields;                 ///< a table of all keys but "command" and "id"
  double received = 0.0;            ///< on the server's clock [s]
  std::string line = {};            ///< as it came
  std::optional<double> acts = {};  ///< when, as a log says [s]
};

/// What the first line of a connection says.
struct Handshake {
  std::string token;
  bool waits = false;  ///< when the queue is full, reading stops; else commands are answered "busy"
};

/// The names of all commands (serve/commands/commands.h).
[[nodiscard]] std::span<const std::string_view> command_names();

/// Reads a command (docs/formats/serve.md). Nesting is counted while it is read, a key may stand
/// once, numbers are finite, text is UTF-8.
/// \param names  of the commands that there are; they outlive what is read
/// \throws Refusal ("json", "limit", "command")
[[nodiscard]] Command read_command(std::string_view line, const SessionLimits& limits,
                                   std::span<const std::string_view> names = command_names());

/// The number of a key as it stands there; none: it has none, or something else.
[[nodiscard]] std::optional<double> number_said(const TomlValue& fields, std::string_view key);

/// A value as an id, JSON; none: it is neither a number nor a text.
[[nodiscard]] std::optional<std::string> id_text(const TomlValue& value);

/// \throws Refusal ("handshake") whose message says nothing of the line
[[nodiscard]] Handshake read_handshake(std::string_view line);

/// The id of a line that is no command, however far it can be read; "null" if it has none up to
/// there, or two.
[[nodiscard]] std::string id_of(std::string_view line, const SessionLimits& limits);

}  // namespace asdic::detail::serve
