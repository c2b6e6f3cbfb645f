#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace asdic::detail {

/// One-sided power spectral density of a pressure, at even frequencies.
struct PowerSpectrum {
  double first_frequency = 0.0;   ///< [Hz]
  double frequency_step = 0.0;    ///< [Hz]
  int segments = 0;               ///< whose mean it is
  std::vector<double> density{};  ///< [frequencies] [Pa²/Hz]
};

/// Power spectral density by Welch's method: the mean of periodograms of segments, each under a
/// Hann window w and half over the one before. With x_m the m-th segment of L samples, r the sample
/// rate and X_m(k) = Σ w_i x_m,i e^{−i2πki/L},
///
///   S(k·r/L) = 2/(r Σ w²) · mean over m of |X_m(k)|²,   w_i = sin²(πi/L), Σ w² = 3L/8
///
/// without the 2 at k = 0 and k = L/2, so that Σ S·r/L is the mean of Σ w² x²/Σ w² (Parseval). No
/// mean or trend is taken out. Samples behind the last whole segment are left out. A tone of
/// amplitude a at one of the frequencies has a²/2 in that and the two beside it.
/// Source: Welch, IEEE Trans. Audio Electroacoust. 15, 70 (1967); docs/theory/studies.md
/// \param pressure  [samples] [Pa]   \param length  L, even, at most the samples
/// \return          [L/2 + 1] from 0 to half the sample rate
[[nodiscard]] PowerSpectrum power_spectrum(std::span<const float> pressure, double sample_rate,
                                           std::size_t length);

/// The same of p(t) = Re(x e^{i2πf_c t}) by its complex envelope x: S at f_c + k·r/L is half of
/// |X(k)|²/(r Σ w²), as the mean of p² is half of that of |x|².
/// \param carrier  f_c [Hz]   \return  [L] from f_c − r/2 on
[[nodiscard]] PowerSpectrum power_spectrum(std::span<const std::complex<float>> envelope,
                                           double sample_rate, double carrier, std::size_t length);

/// Segments for a frequency step of at most this: an even length of which transforms are fast.
/// \param step  [Hz], above 0
[[nodiscard]] std::size_t segment_length(double sample_rate, double step);

}  // namespace asdic::detail
