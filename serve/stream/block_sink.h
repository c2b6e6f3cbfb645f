#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "serve/listening.h"

namespace asdic::detail::serve {

/// Where the samples of one `listen` go in place of its client. Its end is the stream's.
class BlockSink {
 public:
  BlockSink() = default;
  virtual ~BlockSink() = default;
  BlockSink(const BlockSink&) = delete;
  BlockSink& operator=(const BlockSink&) = delete;

  /// In the order of their numbers. It waits for no reader.
  virtual void take(const Listening::Block& block) = 0;
};

/// Of the blocks of a stream.
struct BlockShape {
  std::size_t channels = 1;
  std::size_t samples = 1;  ///< of each block but a last one
  std::size_t components = 1;

  [[nodiscard]] std::size_t bytes() const noexcept {
    return channels * samples * components * sizeof(float);
  }
};

/// A way out of the server that its starter has opened, for one stream at a time.
class BlockOutlet {
 public:
  BlockOutlet() = default;
  virtual ~BlockOutlet() = default;
  BlockOutlet(const BlockOutlet&) = delete;
  BlockOutlet& operator=(const BlockOutlet&) = delete;

  [[nodiscard]] virtual std::size_t longest_block() const = 0;  ///< [bytes]
  [[nodiscard]] virtual std::size_t most_channels() const = 0;  ///< that descriptors have room for
  /// \return none: another stream has it
  [[nodiscard]] virtual std::shared_ptr<BlockSink> open(const BlockShape& shape) = 0;
};

}  // namespace asdic::detail::serve
