#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace asdic::detail {

/// Segments of a grid of impulses, all of one length, with an FFT each in place of the whole
/// grid's: returns of a few rings are received in a few of them. Pulses and phones reach beyond the
/// returns' samples on either side: so much of a window is left free of returns.
/// docs/theory/synthesis.md, "Memory"
struct DelayWindows {
  std::size_t length = 0;           ///< of a window [samples]; 0: none was found
  std::size_t beside = 0;           ///< of it free of returns, on both sides together
  std::vector<std::size_t> begins;  ///< first samples that may hold returns, rising

  /// Samples of a window that may hold returns.
  [[nodiscard]] std::size_t width() const noexcept { return length - beside; }

  /// Windows that hold all of the samples. The first time, of the length that makes their FFTs
  /// cheapest; the same from then on, as long as a third of it holds returns. \param samples
  /// rising   \param margin  free on either side   \param whole  length of the grid
  /// \return whether they are cheaper than the grid's own FFT; always once they were
  [[nodiscard]] bool fit(std::span<const std::size_t> samples, std::size_t margin,
                         std::size_t whole);
};

}  // namespace asdic::detail
