#pragma once
#include "sonar/noise_spectra/spectrum.h"

namespace asdic::detail {

/// Knudsen, Alford & Emling's curves (J. Mar. Res. 7, 410, 1948): N(1 kHz) − 17 lg f_kHz; below 100
/// Hz, where the curves end, that of 100 Hz.
struct KnudsenNoise {
  static constexpr std::string_view name = "knudsen";
  double sea_state = 3.0;  ///< 0 … 6, between whole ones straight in dB

  void describe(Fields& field);
  [[nodiscard]] double level_at(double frequency) const noexcept;
  /// With the wind speed [m/s] up to which there are sea states: beyond, that of the strongest wind
  /// is taken.
  [[nodiscard]] static const Validity& validity() noexcept;
  [[nodiscard]] std::string text() const;

  /// The sea state of a wind, out of the middles of the Beaufort ranges beside which Wenz (1962)
  /// lists the sea states 0, ½, 1 … 6; straight between them. \param wind_speed  [m/s]
  [[nodiscard]] static double sea_state_of_wind(double wind_speed) noexcept;
};
static_assert(NoiseSpectrum<KnudsenNoise>);

}  // namespace asdic::detail
