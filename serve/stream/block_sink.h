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

/// A way out of the server that its starter has opened, for one stream at a time.
class BlockOutlet {
 public:
  BlockOutlet() = default;
  virtual ~BlockOutlet() = default;
  BlockOutlet(const BlockOutlet&) = delete;
  BlockOutlet& operator=(const BlockOutlet&) = delete;

  [[nodiscard]] virtual std::size_t longest_block() const = 0;  ///< [bytes]
  /// \param samples  of each block but a last one \return none: another stream has it
  [[nodiscard]] virtual std::shared_ptr<BlockSink> open(std::size_t samples) = 0;
};

}  // namespace asdic::detail::serve
