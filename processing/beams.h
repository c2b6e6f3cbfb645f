#pragma once
#include <complex>
#include <span>

#include "core/units.h"
#include "sonar/signal/fft.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// Spectra of beams, bin by bin as the transform of a baseband's row gives them.
struct BeamSpectra {
  std::size_t beams = 0, bins = 0, stride = 0;
  FftBuffer<std::complex<float>> values;  ///< [beams × stride]

  [[nodiscard]] const std::complex<float>* beam(std::size_t b) const noexcept {
    return values.data() + b * stride;
  }
  [[nodiscard]] std::complex<float>* beam(std::size_t b) noexcept {
    return values.data() + b * stride;
  }
};

/// The spectrum of every channel.
[[nodiscard]] BeamSpectra channel_spectra(const Baseband& baseband);

/// Conventional beams: b(f) = Σ_n w_n p_n(f) e^{−i2πf·look·x_n/c}, the delays exact over the band.
///
/// The power gain over white noise is 1/Σw², the number of phones for equal weights.
/// \param channels  of channel_spectra(baseband)   \param phones  [channels] relative to the point
/// that delays refer to [m]   \param looks  unit vectors towards the source   \param weights
/// [channels], sum 1   \throws InputError if phones or weights do not match the channels
[[nodiscard]] BeamSpectra conventional_beams(const BeamSpectra& channels, const Baseband& baseband,
                                             std::span<const Vec3> phones,
                                             std::span<const Vec3> looks, double sound_speed,
                                             std::span<const double> weights);

}  // namespace asdic::detail
