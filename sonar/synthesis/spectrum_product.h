#pragma once
#include <complex>
#include <cstddef>

namespace asdic::detail {

/// sum[k] += grid[k]·spectrum[k] over the band, grid in FFT order.
inline void multiply_add(const std::complex<float>* grid, const std::complex<float>* spectrum,
                         std::size_t length, std::size_t highest_bin, std::complex<float>* sum) {
  const auto part = [&](std::size_t first, std::size_t count, const std::complex<float>* h) {
    const float* __restrict a = reinterpret_cast<const float*>(grid + first);
    const float* __restrict b = reinterpret_cast<const float*>(h);
    float* __restrict c = reinterpret_cast<float*>(sum + first);
    for (std::size_t i = 0; i < 2 * count; i += 2) {
      c[i] += a[i] * b[i] - a[i + 1] * b[i + 1];
      c[i + 1] += a[i] * b[i + 1] + a[i + 1] * b[i];
    }
  };
  part(length - highest_bin, highest_bin, spectrum);
  part(0, highest_bin + 1, spectrum + highest_bin);
}

}  // namespace asdic::detail
