#pragma once
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include "core/units.h"

namespace asdic::detail {

/// e^{i2π(start + step·n)} of the samples n = 0, 1, …, block by block: a block's turns are those of
/// the first, turned on, so that no product waits for the one before.
class RotatingPhase {
 public:
  static constexpr std::size_t block = 64;

  /// \param start, step  [cycles]
  RotatingPhase(double start, double step) : next_(unit(start)) {
    real_[0] = 1.0F;
    imaginary_[0] = 0.0F;
    on_ = unit(step);
    for (std::size_t m = 1; m < block; m *= 2, on_ *= on_) {  // on_ = e^{i2π·step·m}
      const auto c = static_cast<float>(on_.real()), s = static_cast<float>(on_.imag());
      for (std::size_t j = 0; j < m; ++j) {
        real_[m + j] = real_[j] * c - imaginary_[j] * s;
        imaginary_[m + j] = real_[j] * s + imaginary_[j] * c;
      }
    }
  }

  /// Turns the next block. \param samples  real and imaginary part in turn
  void rotation(std::array<float, 2 * block>& samples) {
    const auto c = static_cast<float>(next_.real()), s = static_cast<float>(next_.imag());
    for (std::size_t j = 0; j < block; ++j) {
      const float real = real_[j] * c - imaginary_[j] * s;
      const float imaginary = real_[j] * s + imaginary_[j] * c;
      const float x = samples[2 * j], y = samples[2 * j + 1];
      samples[2 * j] = x * real - y * imaginary;
      samples[2 * j + 1] = x * imaginary + y * real;
    }
    next_ *= on_;
  }

 private:
  [[nodiscard]] static std::complex<double> unit(double cycles) {
    return std::polar(1.0, 2.0 * pi * (cycles - std::nearbyint(cycles)));
  }

  std::array<float, block> real_, imaginary_;  // of the first block, from 1 on
  std::complex<double> next_, on_;             // the next block's first; from block to block
};

}  // namespace asdic::detail
