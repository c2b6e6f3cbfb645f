#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/level_namespace.h"

namespace asdic::detail {

/// Lays an impulse between the samples of a grid: eight taps of a Kaiser–Bessel bump, so that after
/// division by the bump's spectrum() the impulse is exact for frequencies inside the band.
///
/// With the band at most 1/oversampling of the sample rate the images are at −94 dB at the band's
/// edge and below −107 dB in its inner three quarters (at 1.25 they would be at −82 and −98).
/// Source: Jackson et al., IEEE Trans. Med. Imaging 10, 473 (1991);
/// docs/theory/synthesis.md, "Spreading".
class DelayKernel {
 public:
  static constexpr int taps = 8;
  static constexpr int before = taps / 2 - 1;   ///< taps before the sample at or below the impulse
  static constexpr double oversampling = 1.35;  ///< least sample rate over width of the band

  /// Real taps, each twice: as they multiply interleaved complex samples.
  using Weights = Eigen::Array<float, 2 * taps, 1, Eigen::DontAlign>;

  DelayKernel();
  /// One is as good as another.
  [[nodiscard]] static const DelayKernel& shared();

  /// \param fraction  of the impulse's place after the sample below it, in [0, 1)
  [[nodiscard]] Weights weights(float fraction) const noexcept {
    const float y = 2.0F * fraction - 1.0F;
    Weights sum = polynomial_[degree];
    for (std::size_t i = degree; i-- > 0;) sum = sum * y + polynomial_[i];
    return sum;
  }

  /// The bump's Fourier transform. \param frequency in cycles per sample, |·| ≤ ½/oversampling
  [[nodiscard]] double spectrum(double frequency) const noexcept;

 private:
  static constexpr std::size_t degree = 9;
  std::array<Weights, degree + 1> polynomial_;  // in y = 2·fraction − 1, one polynomial per tap
};

}  // namespace asdic::detail
