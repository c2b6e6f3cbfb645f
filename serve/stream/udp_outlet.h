#pragma once
#include <functional>
#include <memory>
#include <string>

#include "serve/stream/block_sink.h"
#include "serve/stream/packets.h"

namespace asdic::detail::serve {

/// Sends the streams of a server by UDP to one place, or to a group (docs/formats/stream.md).
class UdpOutlet : public BlockOutlet {
 public:
  /// \param destination  "HOST:PORT"   \param interface  address of the interface that multicast
  /// leaves by; "": the system's choice   \param report  is told when sending fails, once
  /// \throws InputError{where: "--udp", "--udp-interface"}, RunError if there is no such socket
  UdpOutlet(const std::string& destination, const std::string& interface,
            std::function<void(const std::string&)> report);
  ~UdpOutlet() override;

  [[nodiscard]] std::size_t longest_block() const override;
  [[nodiscard]] std::size_t most_channels() const override;
  [[nodiscard]] std::shared_ptr<BlockSink> open(const BlockShape& shape) override;

 private:
  class Sender;
  class Sink;
  std::shared_ptr<Sender> sender_;
};

/// What was received within some time; one thread.
class UdpReceiver {
 public:
  /// \param place  "HOST:PORT": an address of this machine, or a group, which is joined
  /// \param interface  as above, for a group \throws InputError, RunError as UdpOutlet
  UdpReceiver(const std::string& place, const std::string& interface);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  /// The next packet, valid until the next call; no bytes if none comes.   \param seconds  longest
  /// time to wait
  [[nodiscard]] Datagram next(double seconds);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace asdic::detail::serve
