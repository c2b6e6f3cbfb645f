#pragma once
#include <functional>
#include <memory>
#include <string>
#include <system_error>

#include "serve/session_worker.h"

namespace asio {
class io_context;
}

namespace asdic::detail::serve {

/// One client: bytes in, bytes out, and a session with a thread of its own.
///
/// All but that thread runs in the io_context's. Nothing grows: lines, waiting commands and
/// answers that a slow reader has not taken are bounded; past the last no more is read from it.
class Connection {
 public:
  struct Ends {
    int in = -1, out = -1;  ///< file descriptors, closed by the connection
    bool socket = true;     ///< with the times of a socket: for its handshake, and idle
    std::string token;      ///< that the client must know; empty: none
    /// Asked once its handshake is good: whether there is a place for it. None: there is.
    std::function<bool()> admits = {};
  };

  /// \param closed  called when all is over, in the io_context's thread
  Connection(asio::io_context& io, Engine& engine, const Ends& ends, std::function<void()> closed);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start();
  /// Says that all places are taken, and closes.
  void turn_away();
  /// Closes at once: another needs the room.
  void displace();
  /// The ping in hand is finished and answered, commands that wait are refused, then it closes.
  void stop();
  /// Why the client's handshake was refused; "": it was not.
  [[nodiscard]] const std::string& refused() const noexcept;
  /// Error of the write that failed; none where all was written or the client has closed its end.
  [[nodiscard]] std::error_code unwritten() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace asdic::detail::serve
