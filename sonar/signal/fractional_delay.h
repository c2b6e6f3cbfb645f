#pragma once
#include <complex>
#include <vector>

namespace asdic::detail {

/// A complex signal between its samples: 16 taps of a sinc under a Kaiser window, out of a table of
/// 1024 places that is straight between them.
///
/// For signals within ± a quarter of their sample rate (twice oversampled) the error is below
/// −90 dB. Kaiser & Schafer, IEEE Trans. ASSP 28, 105 (1980).
class FractionalDelay {
 public:
  static constexpr int taps = 16;

  FractionalDelay();

  /// \param at  the sample at or before the place, real and imaginary part in turn; seven samples
  /// before and eight after it are read   \param fraction  0 ≤ · < 1 of the way to the next
  [[nodiscard]] std::complex<float> operator()(const float* at, float fraction) const noexcept;

 private:
  static constexpr int places = 1024;
  std::vector<float> weights_;  // [places + 1][taps]
};

}  // namespace asdic::detail
