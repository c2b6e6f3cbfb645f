#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "serve/session.h"

namespace asdic::detail::serve {

/// Where a server is reached. With neither socket nor port: on standard input and output, until
/// that ends.
struct Address {
  std::filesystem::path socket;       ///< Unix socket, for its owner alone; empty: none
  std::optional<std::uint16_t> port;  ///< TCP on 127.0.0.1; 0: one that is free
  std::string token;                  ///< that TCP's clients must know
};

/// Serves sessions to clients (docs/formats/serve.md). The program ignores SIGPIPE.
class Server {
 public:
  /// Opens the sockets; settings.report is told where it listens.
  /// \throws InputError if the scenario is wrong, or a socket's name is taken by something else
  /// \throws RunError if it cannot be opened
  Server(SessionSettings settings, const Address& address);
  ~Server();  ///< removes the socket
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Until the one client of standard input is done, or a stop is requested: then pings in hand are
  /// finished.
  void run(const std::stop_token& stop);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace asdic::detail::serve
