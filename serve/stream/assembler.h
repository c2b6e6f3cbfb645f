#pragma once
#include <bitset>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "serve/stream/packets.h"

namespace asdic::detail::serve {

/// Puts the packets of a stream together again, in whatever order they come, and tells what is
/// missing. Whatever bytes it is fed: memory stays bounded, and nothing is put together out of
/// pieces of different messages.
///
/// Blocks come out in their order. One that lacks a piece is waited for until `window` blocks later
/// something has arrived; then it is lost, whole. Before join() no block is taken: what its bytes
/// mean is not known yet.
class Assembler {
 public:
  struct Message {
    PacketKind kind = PacketKind::block;
    std::int64_t block = 0;      ///< its number; of a descriptor, of the next block
    std::uint32_t sequence = 0;  ///< of its first packet
    std::uint32_t packets = 1;
    std::string content;
    std::uint64_t lost = 0;  ///< blocks directly before it
  };
  struct Counts {
    std::uint64_t packets = 0;      ///< taken
    std::uint64_t lost = 0;         ///< packets, by the gaps in their numbers
    std::uint64_t reordered = 0;    ///< came after a later one
    std::uint64_t duplicates = 0;   ///< came again
    std::uint64_t foreign = 0;      ///< no packets, or not of this stream, or too late
    std::uint64_t blocks = 0;       ///< given
    std::uint64_t lost_blocks = 0;  ///< not whole
  };
  using Give = std::function<void(Message&&)>;
  static constexpr std::int64_t window = 4;  ///< blocks

  /// A stream begins, or is joined. \param descriptor  that says so: what was sent before it does
  /// not belong to it   \param block  the first one   \param longest  bytes of a block
  void join(const Message& descriptor, std::int64_t block, std::size_t longest);
  [[nodiscard]] bool joined() const noexcept { return longest_ > 0; }

  /// \param give  is told what is whole by it, a descriptor at once; it may call join()
  void take(std::string_view bytes, const Give& give);
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
  [[nodiscard]] bool is_new(const Packet& packet);
  void take_descriptor(const Packet& packet, const Give& give);
  void take_block(const Packet& packet, const Give& give);
  void pass_to(std::int64_t block, const Give& give);
  void give_whole(const Give& give);

  Counts counts_;
  std::map<std::uint32_t, Partial> descriptors_;  // by the sequence number of their first packets
  std::map<std::int64_t, Partial> blocks_;        // of the window
  std::int64_t next_ = 0;
  std::uint64_t lost_ = 0;  // blocks since the last one that was given
  std::size_t longest_ = 0;
  std::uint32_t begin_ = 0;  // sequence number before which nothing belongs to the stream
  std::uint32_t latest_ = 0;
  static constexpr std::size_t remembered = 4096;  // packets
  std::bitset<remembered> seen_;                   // by sequence number modulo that
};

}  // namespace asdic::detail::serve
