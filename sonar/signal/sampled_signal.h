#pragma once
#include <complex>
#include <span>
#include <vector>

namespace asdic::detail {

/// A complex signal between its samples: band-limited interpolation, windowed sinc.
///
/// The signal must lie within ± a quarter of its sample rate (twice oversampled); a Kaiser window
/// over 16 samples then leaves an error below −110 dB. Zero outside the samples. Source: Kaiser &
/// Schafer, IEEE Trans. ASSP 28, 105 (1980).
class SampledSignal {
 public:
  SampledSignal() = default;
  /// \param first  time of the first sample [s]   \param rate  [Hz]
  SampledSignal(const std::vector<std::complex<double>>& samples, double first, double rate);

  [[nodiscard]] std::complex<double> at(double t) const noexcept;
  /// Real and imaginary parts at many times. \param t  [n]
  void at(std::span<const double> t, std::span<double> real,
          std::span<double> imaginary) const noexcept;

  [[nodiscard]] double rate() const noexcept { return rate_; }

 private:
  std::vector<double> real_, imaginary_;  // with as many zeros at either end as the window reaches
  double first_ = 0.0, rate_ = 1.0, count_ = 0.0;
};

}  // namespace asdic::detail
