#pragma once
#include <complex>
#include <cstddef>
#include <span>

#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// What a receiver keeps of the spectrum.
struct ListeningBand {
  double centre = 0.0;  ///< [Hz]
  double width = 0.0;   ///< that passes unchanged [Hz]; 0 after a fifth more

  /// Of the filter. \param frequency  [Hz]
  [[nodiscard]] double gain(double frequency) const noexcept;
};

/// Filters every phone to a band and shifts it to frequency zero: p₊(t)·e^{−i2πf_c t}, |·| the peak
/// envelope.
///
/// One FFT a phone: the bins of the band are all that is kept (positive frequencies, doubled),
/// their inverse FFT is the envelope. The edges fall as a raised cosine over a tenth of the width
/// on either side, so a click has died within 60/width. White noise of one-sided density N₀ becomes
/// complex noise of two-sided density 2N₀. The new rate is twice the width or a little more.
/// Source: docs/theory/processing.md, eq. (1)
/// \param pressure  [channels × samples] [Pa]   \param start  time of the first sample [s]
/// \param silence   put after the record, so that what a filter as long as this does at the
/// record's
///                  end does not come round into its start [s]
/// \throws InputError ("band") if the band is empty or not below half the sample rate
[[nodiscard]] Baseband to_baseband(std::span<const float> pressure, std::size_t channels,
                                   double sample_rate, double start, const ListeningBand& band,
                                   double silence);

/// The same of phones that were recorded as complex baseband around `carrier` [Hz].
/// \param envelope  [channels × samples] p₊(t)·e^{−i2π·carrier·t} [Pa]
[[nodiscard]] Baseband to_baseband(std::span<const std::complex<float>> envelope,
                                   std::size_t channels, double sample_rate, double carrier,
                                   double start, const ListeningBand& band, double silence);

}  // namespace asdic::detail
