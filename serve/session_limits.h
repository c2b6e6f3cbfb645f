#pragma once
#include <cstddef>

namespace asdic::serve {

/// What one client may ask for; past a limit a command is refused by a message.
struct SessionLimits {
  std::size_t line_bytes = 1 << 20;       ///< of one command
  int nesting = 16;                       ///< of its JSON
  std::size_t samples = 1 << 22;          ///< of one channel
  std::size_t channels = 1024;            ///< of all arrays
  std::size_t patches = 4'000'000;        ///< returns of the reverberation in one ping
  std::size_t memory_bytes = 1ULL << 32;  ///< that a ping may need
  int queued_pings = 8;                   ///< further ones are answered "busy"
  int connections = 8;                    ///< at a time
  double idle_seconds = 600.0;            ///< after which a silent client is closed
};

}  // namespace asdic::serve
