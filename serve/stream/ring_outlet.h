#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>

#include "serve/stream/block_sink.h"

namespace asdic::detail::serve {

/// Writes the streams of a server into a ring of blocks in a file that programs of this machine
/// map: /dev/shm/NAME, say (docs/formats/stream.md). It waits for no reader; who was overtaken sees
/// it by numbers around each block. The file goes with its server.
class RingOutlet : public BlockOutlet {
 public:
  /// \param bytes  of the file, at least 64 kB
  /// \throws InputError{where: "--ring"} if something else has the name, or another server the ring
  /// \throws RunError if it cannot be made, or there is no room
  RingOutlet(const std::filesystem::path& path, std::size_t bytes);
  ~RingOutlet() override;

  [[nodiscard]] std::size_t longest_block() const override;
  [[nodiscard]] std::size_t most_channels() const override;
  [[nodiscard]] std::shared_ptr<BlockSink> open(const BlockShape& shape) override;

 private:
  class File;
  class Sink;
  std::shared_ptr<File> file_;
};

}  // namespace asdic::detail::serve
