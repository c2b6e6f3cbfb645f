#pragma once
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "core/rotate_back.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {

/// Samples of a period on the grid that reverberation has for itself: at least so many, and a
/// multiple of 16, since FFTW takes twice as long for odd ones.
[[nodiscard]] inline std::size_t grid_length(double least) {
  constexpr std::size_t lanes = 16;
  return lanes *
         fast_fft_length(static_cast<std::size_t>(std::ceil(least / static_cast<double>(lanes))));
}

/// e^{−i2πk·delay/period} of the bins k = 0 … highest: what is that much later. \return [highest+1]
[[nodiscard]] inline std::vector<std::complex<float>> delay_of_bins(double delay, double period,
                                                                    std::size_t highest) {
  std::vector<std::complex<float>> turned;
  turned.reserve(highest + 1);
  for (std::size_t k = 0; k <= highest; ++k) {
    double re = 1.0, im = 0.0;
    rotate_back(static_cast<double>(k) * delay / period, re, im);
    turned.emplace_back(std::complex<double>(re, im));
  }
  return turned;
}

}  // namespace asdic::detail
