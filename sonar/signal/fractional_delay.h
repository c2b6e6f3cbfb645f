#pragma once
#include <complex>
#include <cstdint>
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
  /// One is as good as another.
  [[nodiscard]] static const FractionalDelay& shared();

  /// \param samples  from sample `first` on, real and imaginary part in turn; seven before the one
  /// at or before the place and eight after it are read   \param place  in samples
  [[nodiscard]] std::complex<float> at(const float* samples, std::int64_t first,
                                       double place) const noexcept;

 private:
  static constexpr int places = 1024;
  // [places + 2][taps]: a place that float rounds up to the next sample reads the row after that,
  // of zeros, and weighs it by 0
  std::vector<float> weights_;
};

}  // namespace asdic::detail
