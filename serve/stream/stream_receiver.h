#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "serve/stream/assembler.h"
#include "serve/stream/descriptor.h"

namespace asdic::detail::serve {

/// Blocks of a stream out of its packets (docs/formats/stream.md). The receiver is bound to the
/// stream that it joins first. It takes the same server's next stream when that begins, and another
/// server's when the joined one has ended or been silent for Assembler::silence.
class StreamReceiver {
 public:
  struct Block {
    std::int64_t number = 0;
    double time = 0.0;       ///< of its first sample [s]
    std::uint64_t lost = 0;  ///< blocks directly before it
    std::size_t samples = 0;
    std::vector<float> pressure;  ///< [channels × samples × components] [Pa]
  };
  using Give = std::function<void(Block&&)>;

  void take(const Datagram& packet, const Give& give);

  [[nodiscard]] const std::optional<Descriptor>& about() const noexcept { return about_; }
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  [[nodiscard]] const Assembler::Counts& counts() const noexcept { return assembler_.counts(); }

 private:
  void described(const Assembler::Message& message, const Assembler::Give& give);
  [[nodiscard]] Block block_of(const Assembler::Message& message) const;

  Assembler assembler_;
  std::optional<Descriptor> about_;
  bool ended_ = false;
};

}  // namespace asdic::detail::serve
