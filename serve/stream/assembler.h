#pragma once
#include <bitset>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <tuple>

#include "serve/stream/packets.h"

namespace asdic::detail::serve {

/// Puts the packets of a stream together, in whatever order they come, and reports what is missing.
/// Memory stays bounded for any input, and no message is made of pieces of different messages.
///
/// Blocks come out in their order. One that lacks a piece is waited for until `window` blocks later
/// something has arrived; then it is lost, whole. Before join() no block is taken, because the
/// meaning of its bytes is not known yet. Afterwards only packets with the stream's number and
/// sender are taken. Only descriptors of other streams are read, and such a stream may be joined if
/// may_join() allows it.
class Assembler {
 public:
  struct Message {
    PacketKind kind = PacketKind::block;
    std::int64_t block = 0;      ///< its number; of a descriptor, of the next block
    std::uint32_t sequence = 0;  ///< of its first packet
    std::uint32_t packets = 1;
    std::uint64_t stream = 0;  ///< number of the stream
    std::string sender = {};
    double time = 0.0;  ///< time of its last packet [s]
    std::string content = {};
    std::uint64_t lost = 0;  ///< blocks directly before it
  };
  struct Counts {
    std::uint64_t packets = 0;      ///< taken
    std::uint64_t lost = 0;         ///< packets, by the gaps in their numbers
    std::uint64_t reordered = 0;    ///< came after a later one
    std::uint64_t duplicates = 0;   ///< came again
    std::uint64_t foreign = 0;      ///< not asdic packets, impossible in the stream, or too late
    std::uint64_t others = 0;       ///< packets of other senders while the stream goes on
    std::uint64_t blocks = 0;       ///< given
    std::uint64_t lost_blocks = 0;  ///< not whole
  };
  using Give = std::function<void(Message&&)>;
  static constexpr std::int64_t window = 4;  ///< blocks

  static constexpr double silence = 5.0;  ///< after which another sender's stream may be joined [s]

  /// Sizes of a stream's blocks [bytes].
  struct Sizes {
    std::size_t longest = 0;  ///< size of each block but the last, which may be shorter
    std::size_t sample = 1;   ///< size of one sample of all phones, of which a block has whole ones
  };
  /// Begins or joins a stream. \param descriptor  of the stream; packets sent before it do not
  /// belong to the stream   \param block  number of the first block
  void join(const Message& descriptor, std::int64_t block, const Sizes& sizes);
  [[nodiscard]] bool joined() const noexcept { return sizes_.longest > 0; }
  /// Whether a descriptor belongs to the stream that has been joined.
  [[nodiscard]] bool is_own(const Message& descriptor) const noexcept {
    return joined() && descriptor.stream == stream_ && descriptor.sender == sender_;
  }
  /// Whether the stream of a descriptor may take the place of the joined one. The same sender's
  /// next stream may at once; another sender's may after the joined one has ended or been silent.
  [[nodiscard]] bool may_join(const Message& descriptor) const noexcept;

  /// \param give  called with each message that is complete, with a descriptor at once; it may call
  /// join() or go_on()
  void take(const Datagram& datagram, const Give& give);
  /// Takes note of a descriptor of the joined stream. After a gap that is too long to count, the
  /// blocks before `block` are lost.
  void go_on(const Message& descriptor, std::int64_t block, const Give& give);
  /// No more comes: what is whole is given, the rest is lost. \param next  number of the block that
  /// would follow: those before it that did not come are lost, too
  void finish(std::int64_t next, const Give& give);
  [[nodiscard]] std::int64_t next() const noexcept { return next_; }  ///< block that is waited for

  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  struct Partial {
    std::uint32_t first = 0;  // sequence number
    std::uint16_t fragments = 0;
    std::map<std::uint16_t, std::string> pieces = {};

    [[nodiscard]] bool whole() const noexcept { return pieces.size() == fragments; }
    [[nodiscard]] std::string content() const;
  };
  using Key =
      std::tuple<std::string, std::uint64_t, std::uint32_t>;  // sender, stream, first packet
  using Descriptors = std::map<Key, Partial>;
  [[nodiscard]] bool is_new(const Packet& packet);
  void begin_at(const Message& descriptor);
  void take_descriptor(const Packet& packet, const Datagram& datagram, Descriptors& waiting,
                       const Give& give);
  void take_block(const Packet& packet, const Give& give);
  void pass_to(std::int64_t block, const Give& give);
  void give_whole(const Give& give);

  Counts counts_;
  std::string sender_;
  std::uint64_t stream_ = 0;
  bool over_ = false;
  double heard_ = 0.0;                      // time of the stream's last packet [s]
  Descriptors own_, others_;                // incomplete ones
  std::map<std::int64_t, Partial> blocks_;  // of the window
  std::int64_t next_ = 0;
  std::uint64_t lost_ = 0;  // blocks since the last one that was given
  Sizes sizes_;
  std::uint32_t begin_ = 0;        // sequence number before which nothing belongs to the stream
  std::int64_t known_block_ = 0;   // block of the latest descriptor
  std::uint32_t known_after_ = 0;  // sequence number after that
  std::uint32_t latest_ = 0;
  static constexpr std::size_t remembered = 4096;  // packets
  std::bitset<remembered> seen_;                   // by sequence number modulo that
};

}  // namespace asdic::detail::serve
