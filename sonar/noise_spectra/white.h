#pragma once
#include "sonar/noise_spectra/spectrum.h"

namespace asdic::detail {

/// The same level at all frequencies.
struct WhiteNoise {
  static constexpr std::string_view name = "white";
  double spectral_level_db = 0.0;  ///< NL [dB re 1 µPa²/Hz]

  void describe(Fields& field);
  [[nodiscard]] double level_at(double /*frequency*/) const noexcept { return spectral_level_db; }
  [[nodiscard]] static const Validity& validity() noexcept;  ///< everywhere
  [[nodiscard]] std::string text() const;
};
static_assert(NoiseSpectrum<WhiteNoise>);

}  // namespace asdic::detail
