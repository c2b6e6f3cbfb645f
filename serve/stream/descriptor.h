#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "serve/listening.h"

namespace asdic::detail::serve {

/// What the bytes of a stream's blocks mean, from a block on (docs/formats/stream.md).
struct Descriptor {
  struct Array {
    std::string name;
    std::size_t phones = 1;
  };

  std::uint64_t stream = 0;       ///< number of the stream, drawn at random for each `listen`
  std::int64_t block = 0;         ///< number of the next block
  double time = 0.0;              ///< of its first sample [s]
  double sample_rate = 1.0;       ///< [Hz]
  std::optional<double> carrier;  ///< of complex baseband [Hz]; none: pressure
  std::size_t channels = 1;
  std::size_t block_samples = 1;  ///< of each block but a last one
  std::vector<Array> arrays;
  std::vector<Vec3> positions;  ///< [channels] of all phones on the map at that time [m]
  bool ended = false;           ///< no block comes any more

  [[nodiscard]] std::size_t components() const noexcept { return carrier ? 2 : 1; }
  /// Size of one sample of all phones [bytes].
  [[nodiscard]] std::size_t sample_bytes() const noexcept {
    return channels * components() * sizeof(float);
  }
  /// Size of a block of `block_samples` [bytes].
  [[nodiscard]] std::size_t block_bytes() const noexcept { return block_samples * sample_bytes(); }
};

/// One JSON object.
[[nodiscard]] std::string descriptor_text(const Descriptor& descriptor);
/// None: it is no descriptor, or tells what cannot be.
[[nodiscard]] std::optional<Descriptor> read_descriptor(std::string_view text);

/// Of a stream whose next block this is.
[[nodiscard]] Descriptor descriptor_of(const Listening::Block& block, std::uint64_t stream,
                                       std::size_t block_samples);

/// When a stream is described: at its beginning, where something changes, each second of it.
class DescribedStream {
 public:
  explicit DescribedStream(std::size_t block_samples);

  /// What is to be told before a block; none: nothing. \param block  the next one
  [[nodiscard]] std::optional<std::string> before(const Listening::Block& block);
  /// At its end, after the latest block; none: there was no block.
  [[nodiscard]] std::optional<std::string> end() const;
  [[nodiscard]] std::int64_t next() const noexcept { return next_; }
  [[nodiscard]] std::uint64_t stream() const noexcept { return stream_; }  ///< its number

 private:
  std::uint64_t stream_;
  std::size_t block_samples_;
  std::optional<Descriptor> latest_;
  Listening::Place place_{};
  std::int64_t next_ = 0;
  double next_time_ = 0.0;
};

}  // namespace asdic::detail::serve
