#include "serve/stream/udp_outlet.h"

#include <poll.h>

#include <array>
#include <asio.hpp>
#include <charconv>
#include <chrono>
#include <random>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "serve/stream/descriptor.h"
#include "serve/stream/stream_turn.h"

namespace asdic::detail::serve {
namespace {

using Udp = asio::ip::udp;

/// \throws InputError{where: "--udp"}
Udp::endpoint endpoint_of(asio::io_context& io, const std::string& place) {
  const InputError wrong({.where = "--udp",
                          .got = in_quotes(place),
                          .expected = "HOST:PORT, as 127.0.0.1:4711, [::1]:4711 or a group, "
                                      "239.1.2.3:4711"});
  const std::size_t colon = place.rfind(':');
  if (colon == std::string::npos || colon == 0) throw wrong;
  std::string host = place.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  else if (host.find(':') != std::string::npos)
    throw wrong;
  std::uint16_t port = 0;
  const char* const last = place.data() + place.size();
  const auto [end, bad] = std::from_chars(place.data() + colon + 1, last, port);
  if (bad != std::errc{} || end != last || port == 0) throw wrong;
  std::error_code error;
  const asio::ip::address address = asio::ip::make_address(host, error);
  if (!error) return {address, port};
  Udp::resolver resolver(io);
  const auto found = resolver.resolve(host, "", error);
  if (error || found.empty())
    throw InputError({.where = "--udp",
                      .got = in_quotes(host),
                      .expected = "an address, or the name of a host that is known"});
  return {found.begin()->endpoint().address(), port};
}

/// \throws InputError{where: "--udp-interface"}
asio::ip::address interface_of(const std::string& text) {
  std::error_code error;
  const asio::ip::address address = asio::ip::make_address(text, error);
  if (error)
    throw InputError({.where = "--udp-interface",
                      .got = in_quotes(text),
                      .expected = "the address of an interface of this machine, as 127.0.0.1"});
  return address;
}

}  // namespace

/// The socket, and whose turn it is.
class UdpOutlet::Sender {
 public:
  Sender(const std::string& destination, const std::string& interface,
         std::function<void(const std::string&)> report)
      : to_(endpoint_of(io_, destination)), socket_(io_), report_(std::move(report)) {
    std::error_code error;
    static_cast<void>(socket_.open(to_.protocol(), error));
    if (!error && to_.address().is_multicast()) multicast(interface, error);
    if (error) throw RunError("--udp " + destination + ": " + error.message());
    static_cast<void>(socket_.set_option(asio::socket_base::send_buffer_size(1 << 20), error));
  }

  StreamTurn turn;

  void send(PacketKind kind, std::uint64_t stream, std::int64_t block, std::string_view message) {
    packets_.split(kind, stream, block, message, [&](std::string_view packet) {
      std::error_code error;
      socket_.send_to(asio::buffer(packet.data(), packet.size()), to_, 0, error);
      if (error && !std::exchange(failed_, true))
        report_("--udp " + to_.address().to_string() + ":" + std::to_string(to_.port()) + ": " +
                error.message() + "; what cannot be sent is lost");
    });
  }

 private:
  void multicast(const std::string& interface, std::error_code& error) {
    static_cast<void>(socket_.set_option(asio::ip::multicast::enable_loopback(true), error));
    if (error || interface.empty()) return;
    const asio::ip::address from = interface_of(interface);
    if (from.is_v4() != to_.address().is_v4() || !from.is_v4())
      throw InputError({.where = "--udp-interface",
                        .got = in_quotes(interface),
                        .expected = "an IPv4 address, for a group that has one"});
    static_cast<void>(
        socket_.set_option(asio::ip::multicast::outbound_interface(from.to_v4()), error));
  }

  asio::io_context io_{1};
  Udp::endpoint to_;
  Udp::socket socket_;
  std::function<void(const std::string&)> report_;
  Packets packets_{std::random_device{}()};  // one that begins anew is not taken for the one before
  bool failed_ = false;
};

class UdpOutlet::Sink : public BlockSink {
 public:
  Sink(std::shared_ptr<Sender> sender, std::size_t samples)
      : sender_(std::move(sender)), about_(samples) {}
  ~Sink() override {
    if (const auto end = about_.end())
      for (int i = 0; i < 3; ++i)  // one of them comes
        sender_->send(PacketKind::descriptor, about_.stream(), about_.next(), *end);
    sender_->turn.give_back();
  }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  void take(const Listening::Block& block) override {
    if (const auto text = about_.before(block))
      sender_->send(PacketKind::descriptor, about_.stream(), block.number, *text);
    sender_->send(PacketKind::block, about_.stream(), block.number,
                  {reinterpret_cast<const char*>(block.pressure.data()),
                   block.pressure.size() * sizeof(float)});
  }

 private:
  std::shared_ptr<Sender> sender_;
  DescribedStream about_;
};

UdpOutlet::UdpOutlet(const std::string& destination, const std::string& interface,
                     std::function<void(const std::string&)> report)
    : sender_(std::make_shared<Sender>(destination, interface, std::move(report))) {}
UdpOutlet::~UdpOutlet() = default;

std::size_t UdpOutlet::longest_block() const { return longest_message; }
std::size_t UdpOutlet::most_channels() const { return 32768; }

std::shared_ptr<BlockSink> UdpOutlet::open(const BlockShape& shape) {
  if (!sender_->turn.take()) return nullptr;
  return std::make_shared<Sink>(sender_, shape.samples);
}

class UdpReceiver::Impl {
 public:
  Impl(const std::string& place, const std::string& interface)
      : from_(endpoint_of(io_, place)), socket_(io_) {
    std::error_code error;
    const bool group = from_.address().is_multicast();
    static_cast<void>(socket_.open(from_.protocol(), error));
    if (!error && group)  // several on one machine may listen to it
      static_cast<void>(socket_.set_option(Udp::socket::reuse_address(true), error));
    std::error_code small;  // as large as the system lets it be
    static_cast<void>(socket_.set_option(asio::socket_base::receive_buffer_size(1 << 24), small));
    if (!error) static_cast<void>(socket_.bind(from_, error));
    if (!error && group) join(interface, error);
    if (!error) static_cast<void>(socket_.non_blocking(true, error));
    if (error) throw RunError("--udp " + place + ": " + error.message());
  }

  Datagram next(double seconds) {
    std::error_code error;
    Udp::endpoint sender;
    std::size_t n = socket_.receive_from(asio::buffer(bytes_), sender, 0, error);
    if (error == asio::error::would_block) {
      pollfd one{.fd = socket_.native_handle(), .events = POLLIN, .revents = 0};
      if (::poll(&one, 1, static_cast<int>(seconds * 1000.0)) <= 0) return {};
      n = socket_.receive_from(asio::buffer(bytes_), sender, 0, error);
    }
    if (error) return {};
    if (sender_text_.empty() || sender != sender_) {
      sender_ = sender;
      sender_text_ = sender.address().to_string() + ":" + std::to_string(sender.port());
    }
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return {.bytes = {bytes_.data(), n},
            .sender = sender_text_,
            .time = std::chrono::duration<double>(now).count()};
  }

 private:
  void join(const std::string& interface, std::error_code& error) {
    using Group = asio::ip::multicast::join_group;
    const asio::ip::address group = from_.address();
    if (group.is_v4() && !interface.empty())
      static_cast<void>(
          socket_.set_option(Group(group.to_v4(), interface_of(interface).to_v4()), error));
    else
      static_cast<void>(socket_.set_option(Group(group), error));
  }

  asio::io_context io_{1};
  Udp::endpoint from_, sender_;
  std::string sender_text_;  // sender of the latest datagram
  Udp::socket socket_;
  std::array<char, 65536> bytes_{};
};

UdpReceiver::UdpReceiver(const std::string& place, const std::string& interface)
    : impl_(std::make_unique<Impl>(place, interface)) {}
UdpReceiver::~UdpReceiver() = default;

Datagram UdpReceiver::next(double seconds) { return impl_->next(seconds); }

}  // namespace asdic::detail::serve
