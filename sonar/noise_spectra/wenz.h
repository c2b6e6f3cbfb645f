#pragma once
#include "sonar/noise_spectra/spectrum.h"

namespace asdic::detail {

/// Wenz's ambient noise: turbulence, distant ships, wind (JASA 34, 1936, 1962), without thermal
/// noise. The level is the sum of the powers of
///
///   turbulence  17 − 30 lg f
///   shipping    40 + 20(s − ½) + 26 lg f − 60 lg(f + 0.03)
///   wind        50 + 7.5√w + 20 lg f − 40 lg(f + 0.4)
///
/// f in kHz, w in m/s. Coates, Underwater Acoustic Systems (1990). Below 1 Hz that of 1 Hz.
struct WenzNoise {
  static constexpr std::string_view name = "wenz";
  double shipping = 0.5;     ///< 0 (none) … 1 (heavy)
  double wind_speed = 10.0;  ///< [m/s]

  void describe(Fields& field);
  [[nodiscard]] double level_at(double frequency) const noexcept;
  [[nodiscard]] static const Validity& validity() noexcept;
  [[nodiscard]] std::string text() const;
};
static_assert(NoiseSpectrum<WenzNoise>);

}  // namespace asdic::detail
