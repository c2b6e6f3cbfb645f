#include "serve/server.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <asio.hpp>
#include <chrono>
#include <list>

#include "core/error.h"
#include "serve/connection.h"
#include "serve/refusal.h"
#include "serve/unix_socket.h"

namespace asdic::detail::serve {
namespace {

using Local = asio::local::stream_protocol;
using Tcp = asio::ip::tcp;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Asynchronous reading makes the descriptor non-blocking, for all who share it (a shell, say):
/// afterwards it is as it was.
class KeepFlags {
 public:
  explicit KeepFlags(int descriptor)
      : descriptor_(descriptor), flags_(fcntl(descriptor, F_GETFL)) {}
  ~KeepFlags() {
    if (flags_ >= 0) fcntl(descriptor_, F_SETFL, flags_);
  }
  KeepFlags(const KeepFlags&) = delete;
  KeepFlags& operator=(const KeepFlags&) = delete;

 private:
  int descriptor_, flags_;
};

}  // namespace

class Server::Impl {
 public:
  Impl(SessionSettings settings, const Address& address)
      : settings_(std::move(settings)),
        engine_{.settings = settings_, .clock = seconds, .turns = {}, .owed = {}},
        streams_(address.socket.empty() && !address.port),
        token_(address.token),
        local_(io_),
        tcp_(io_),
        pause_(io_) {
    static_cast<void>(LiveScenario(settings_.scenario, settings_.data, settings_.limits));
    if (!address.socket.empty()) listen(address.socket);
    if (address.port) listen(*address.port);
  }

  void run(const std::stop_token& stop) {
    const std::stop_callback when_asked(stop, [this] { asio::post(io_, [this] { stop_all(); }); });
    if (!streams_) {
      if (local_.is_open()) accept(local_, "");
      if (tcp_.is_open()) accept(tcp_, token_);
      io_.run();
      return;
    }
    const KeepFlags in(STDIN_FILENO), out(STDOUT_FILENO);
    const int mine = dup(STDIN_FILENO), theirs = dup(STDOUT_FILENO);
    if (mine < 0 || theirs < 0) throw RunError("standard input or output is closed");
    open({.in = mine, .out = theirs, .socket = false, .token = ""}, of_socket_, false);
    io_.run();
    if (unwritten_) throw RunError("standard output: " + unwritten_.message());
    if (refused_)
      throw InputError({.where = "standard input: first line",
                        .got = "another",
                        .expected = "{\"asdic\": 1}, the handshake (docs/formats/serve.md)"});
  }

 private:
  /// A connection. Guests have not yet said the handshake.
  struct Client {
    enum class Stand { guest, served, turned_away };
    std::unique_ptr<Connection> connection;
    Stand stand = Stand::guest;
  };
  using Clients = std::list<Client>;
  /// Connections of one listener, in the order in which they came.
  struct Places {
    Clients clients;

    [[nodiscard]] std::size_t count(Client::Stand stand) const {
      return static_cast<std::size_t>(
          std::count_if(clients.begin(), clients.end(),
                        [&](const Client& client) { return client.stand == stand; }));
    }
  };
  /// Who waits longest without a handshake gives way to one more: nobody without the token can keep
  /// those out who have it.
  static constexpr std::size_t most_guests = 32;

  void listen(const std::filesystem::path& path) {
    make_room_for_socket(path);
    std::error_code error;
    const mode_t before = ::umask(0177);  // for its owner alone from the first moment
    static_cast<void>(local_.open(Local(), error));
    if (!error) static_cast<void>(local_.bind(Local::endpoint(path.string()), error));
    ::umask(before);
    if (!error) static_cast<void>(local_.listen(Local::acceptor::max_listen_connections, error));
    if (error) throw RunError("--socket " + path.string() + ": " + error.message());
    name_ = std::make_unique<SocketName>(path);
    settings_.report("listening on " + path.string());
  }

  void listen(std::uint16_t port) {
    std::error_code error;
    static_cast<void>(tcp_.open(Tcp::v4(), error));
    if (!error) static_cast<void>(tcp_.set_option(Tcp::acceptor::reuse_address(true), error));
    if (!error)
      static_cast<void>(tcp_.bind(Tcp::endpoint(asio::ip::address_v4::loopback(), port), error));
    if (!error) static_cast<void>(tcp_.listen(Tcp::acceptor::max_listen_connections, error));
    if (error) throw RunError("--tcp " + std::to_string(port) + ": " + error.message());
    settings_.report("listening on 127.0.0.1:" + std::to_string(tcp_.local_endpoint().port()));
  }

  template <class Acceptor>
  void accept(Acceptor& acceptor, const std::string& token) {
    acceptor.async_accept([this, &acceptor, token](std::error_code error,
                                                   typename Acceptor::protocol_type::socket s) {
      if (stopping_) return;
      if (error) {  // out of descriptors, say: try again when there may be some
        pause_.expires_after(std::chrono::milliseconds(100));
        pause_.async_wait([this, &acceptor, token](std::error_code over) {
          if (!over && !stopping_) accept(acceptor, token);
        });
        return;
      }
      welcome(std::move(s), token);
      accept(acceptor, token);
    });
  }

  template <class Socket>
  void welcome(Socket socket, const std::string& token) {
    std::error_code ignored;
    if constexpr (std::is_same_v<Socket, Tcp::socket>)
      static_cast<void>(socket.set_option(Tcp::no_delay(true), ignored));
    const int in = socket.release(ignored), out = in < 0 ? -1 : dup(in);
    if (out < 0) {
      if (in >= 0) ::close(in);
      return;
    }
    // Peers of one kind cannot take the places of the other: TCP is open to every user here.
    Places& places = std::is_same_v<Socket, Tcp::socket> ? of_tcp_ : of_socket_;
    const std::size_t most = settings_.limits.connections;
    const bool full = places.count(Client::Stand::served) >= most;
    if (full && places.count(Client::Stand::turned_away) >= most) {  // even those that are told so
      ::close(in);
      ::close(out);
      return;
    }
    if (!full && places.count(Client::Stand::guest) >= most_guests) {
      const auto oldest =
          std::find_if(places.clients.begin(), places.clients.end(),
                       [](const Client& client) { return client.stand == Client::Stand::guest; });
      oldest->stand = Client::Stand::turned_away;
      oldest->connection->displace();
    }
    open({.in = in, .out = out, .socket = true, .token = token}, places, full);
  }

  void open(Connection::Ends ends, Places& places, bool full) {
    const auto place = places.clients.emplace(places.clients.end());
    ends.admits = [this, place, &places] {
      const bool free = places.count(Client::Stand::served) < settings_.limits.connections;
      place->stand = free ? Client::Stand::served : Client::Stand::turned_away;
      return free;
    };
    place->connection = std::make_unique<Connection>(io_, engine_, ends, [this, place, &places] {
      refused_ = refused_ || !place->connection->refused().empty();
      unwritten_ = place->connection->unwritten();
      places.clients.erase(place);
    });
    if (full) {
      place->stand = Client::Stand::turned_away;
      place->connection->turn_away();
    } else {
      place->connection->start();
      if (stopping_) place->connection->stop();
    }
  }

  void stop_all() {
    stopping_ = true;
    std::error_code ignored;
    static_cast<void>(local_.close(ignored));
    static_cast<void>(tcp_.close(ignored));
    pause_.cancel();
    for (Places* places : {&of_socket_, &of_tcp_})
      for (Client& client : places->clients) client.connection->stop();
  }

  asio::io_context io_{1};
  SessionSettings settings_;
  Engine engine_;
  bool streams_;
  std::string token_;
  Local::acceptor local_;
  Tcp::acceptor tcp_;
  asio::steady_timer pause_;
  std::unique_ptr<SocketName> name_;
  Places of_socket_, of_tcp_;
  bool refused_ = false;       // whether a handshake was refused
  std::error_code unwritten_;  // error of the answers to the last client
  bool stopping_ = false;
};

Server::Server(SessionSettings settings, const Address& address)
    : impl_(std::make_unique<Impl>(std::move(settings), address)) {}
Server::~Server() = default;

void Server::run(const std::stop_token& stop) { impl_->run(stop); }

}  // namespace asdic::detail::serve
