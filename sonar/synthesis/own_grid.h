#pragma once
#include <cmath>
#include <cstddef>

#include "sonar/signal/fft.h"

namespace asdic::detail {

/// Samples of a period on the grid that reverberation has for itself: at least so many, and a
/// multiple of 16, since FFTW takes twice as long for odd ones.
[[nodiscard]] inline std::size_t grid_length(double least) {
  constexpr std::size_t lanes = 16;
  return lanes *
         fast_fft_length(static_cast<std::size_t>(std::ceil(least / static_cast<double>(lanes))));
}

}  // namespace asdic::detail
