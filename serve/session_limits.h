#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace asdic::detail {
class Fields;
}

namespace asdic::detail::serve {

/// What one client may ask for; past a limit a command is refused by a message.
struct SessionLimits {
  std::size_t line_bytes = 1 << 20;       ///< of one command
  std::size_t nesting = 16;               ///< of its JSON
  std::size_t samples = 1 << 22;          ///< of one channel
  std::size_t channels = 1024;            ///< of all arrays
  std::size_t targets = 64;               ///< of the scenario
  std::size_t patches = 4'000'000;        ///< returns of the reverberation in one ping
  std::size_t rays = 2000;                ///< of a fan
  std::size_t receivers = 1 << 20;        ///< of a field
  std::size_t memory_bytes = 1ULL << 32;  ///< that a ping may need
  std::size_t file_bytes = 16 << 20;      ///< of a file that a command names
  std::size_t kept_bytes = 32 << 20;      ///< of sound paths that a session keeps for later pings
  std::size_t queued_pings = 8;           ///< commands that wait; further ones are answered "busy"
  std::size_t command_seconds = 600;      ///< that a command may compute
  std::size_t client_seconds = 1ULL << 30;      ///< of computing, of a connection in all
  std::size_t connections = 8;                  ///< at a time
  std::size_t output_bytes = 100'000'000'000;   ///< of files, over a server's life
  std::size_t total_answer_bytes = 512U << 20;  ///< that wait, of all connections
  std::size_t answer_bytes = 256U << 20;        ///< that wait for a slow reader
  std::size_t handshake_seconds = 10;           ///< for the first line of a socket's client
  std::size_t idle_seconds = 600;               ///< after which a silent socket is closed

  void describe(Fields& field);
};

/// A limit by its name, as `--limit NAME=VALUE` and the command `limits` have it.
struct NamedLimit {
  std::string_view name;
  std::size_t value;
};
[[nodiscard]] std::vector<NamedLimit> limits_by_name(const SessionLimits& limits);

/// Sets one limit by "NAME=VALUE". \throws InputError{where: "--limit"}
void set_limit(SessionLimits& limits, const std::string& assignment);

}  // namespace asdic::detail::serve
