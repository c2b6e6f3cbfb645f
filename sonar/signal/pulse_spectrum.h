#pragma once
#include <complex>
#include <vector>

namespace asdic::detail {

class Pulse;

/// The spectrum of a pulse around its centre frequency and its centre in time.
///
/// C(ν) = ∫ s₊(u + T/2) e^{−i2π f_c u} e^{−i2πνu} du by the trapezoidal rule on samples far denser
/// than the phones', so that jumps at the edges alias by less than −90 dB of the peak. The period
/// 1/ bin_width is at least 4T: side lobes are not missed, and there is room for the ringing of a
/// filter.
struct PulseSpectrum {
  double bin_width = 0.0;                  ///< [Hz]
  std::vector<std::complex<double>> bins;  ///< [n] C at ν = k·bin_width, k = 0…n/2, −n/2+1…−1 [s]

  [[nodiscard]] double frequency(std::size_t k) const noexcept;  ///< of bin k, re the centre [Hz]
};

/// \param centre  frequency that becomes zero [Hz]
[[nodiscard]] PulseSpectrum pulse_spectrum(const Pulse& pulse, double centre);

/// Full width around zero outside which |C| stays `down_db` below its peak [Hz].
[[nodiscard]] double bandwidth(const PulseSpectrum& spectrum, double down_db);

/// The outermost of n pairs of bins, k = n..1 from the far ends inwards, with which what lies
/// outside exceeds `most`; 0 if none does. \param of_pair  what pair k adds
template <class OfPair>
[[nodiscard]] std::size_t outermost_pair(std::size_t n, double most, OfPair&& of_pair) {
  double outside = 0.0;
  for (std::size_t k = n; k > 0; --k)
    if ((outside += of_pair(k)) > most) return k;
  return 0;
}

/// The narrowest full width around zero that holds a share of the energy Σ|C|²Δν [Hz].
[[nodiscard]] double bandwidth_of_energy(const PulseSpectrum& spectrum, double share);

/// The narrowest full width outside which Σ|C|Δν, a bound of the error of leaving the rest out, is
/// below `error` [Hz]; infinite if that is not reached within half of the analysed band.
[[nodiscard]] double bandwidth_for_error(const PulseSpectrum& spectrum, double error);

}  // namespace asdic::detail
