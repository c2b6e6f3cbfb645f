#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

namespace asdic::detail::serve {

/// What a packet of a stream is for (docs/formats/stream.md).
enum class PacketKind : std::uint8_t { descriptor = 0, block = 1 };

/// A datagram received by UDP.
struct Datagram {
  std::string_view bytes;
  std::string_view sender = {};  ///< "HOST:PORT"
  double time = 0.0;             ///< at which it came, by a clock that never goes back [s]
};

/// A packet: 24 bytes of header, and a piece of a message. A message is a descriptor or a block;
/// each of its pieces but the last is `most_payload` long.
struct Packet {
  static constexpr std::size_t header_bytes = 24;

  PacketKind kind = PacketKind::block;
  std::uint32_t sequence = 0;     ///< of the packet, of all that the server sends
  std::uint32_t block = 0;        ///< number of the block; of a descriptor, of the next one
  std::uint16_t fragment = 0;     ///< of the message, from 0
  std::uint16_t fragments = 1;    ///< that the message has
  std::uint64_t stream = 0;       ///< number of the stream, drawn at random for each `listen`
  std::string_view payload = {};  ///< little endian

  /// Of the message's first fragment: it tells messages apart.
  [[nodiscard]] std::uint32_t first() const noexcept { return sequence - fragment; }
};

inline constexpr std::size_t most_payload = 1408;  ///< whole samples; with all headers below an MTU
inline constexpr std::size_t longest_message = std::size_t{65535} * most_payload;  ///< [bytes]

/// None: these bytes are no packet of a stream.
[[nodiscard]] std::optional<Packet> read_packet(std::string_view bytes);

/// Cuts messages into packets, with numbers that go on from message to message.
class Packets {
 public:
  using Send = std::function<void(std::string_view)>;

  /// \param sequence  of the first packet
  explicit Packets(std::uint32_t sequence = 0) : sequence_(sequence) {}

  /// \param stream  its number   \param message  1 to longest_message bytes
  void split(PacketKind kind, std::uint64_t stream, std::int64_t block, std::string_view message,
             const Send& send);

 private:
  std::uint32_t sequence_;
  std::array<char, Packet::header_bytes + most_payload> packet_{};
};

}  // namespace asdic::detail::serve
