#pragma once
#include "core/validity.h"
#include "sonar/scenario/noise_settings.h"

namespace asdic {

/// Spectral level of Wenz's noise without thermal noise [dB re 1 µPa²/Hz]: the sum of the powers of
///
///   turbulence  17 − 30 lg f
///   shipping    40 + 20(s − ½) + 26 lg f − 60 lg(f + 0.03)
///   wind        50 + 7.5√w + 20 lg f − 40 lg(f + 0.4)
///
/// f in kHz, w in m/s. Coates, Underwater Acoustic Systems (1990). Below 1 Hz that of 1 Hz.
[[nodiscard]] double level_db(const WenzNoise& law, double frequency) noexcept;

/// At which frequencies [Hz] Wenz's curves are.
[[nodiscard]] const Validity& wenz_validity() noexcept;

/// Knudsen's N(1 kHz) − 17 lg f_kHz; below 100 Hz, where the curves end, that of 100 Hz.
[[nodiscard]] double level_db(const KnudsenNoise& law, double frequency) noexcept;

/// At which frequencies [Hz] Knudsen's curves are, and up to which wind speed [m/s] there are sea
/// states: beyond, that of the strongest wind is taken.
[[nodiscard]] const Validity& knudsen_validity() noexcept;

[[nodiscard]] double level_db(const NoiseTable& law, double frequency) noexcept;

/// Of the molecules: −15 + 20 lg f_kHz. Mellen, JASA 24, 478 (1952), as Coates fits it.
[[nodiscard]] double thermal_level_db(double frequency) noexcept;

/// The sea state of a wind, out of the middles of the Beaufort ranges beside which Wenz (1962)
/// lists the sea states 0, ½, 1 … 6; straight between them. \param wind_speed  [m/s]
[[nodiscard]] double sea_state_of_wind(double wind_speed) noexcept;

/// Spectral level of a scenario's noise [dB re 1 µPa²/Hz], −∞ without any.
[[nodiscard]] double noise_level_db(const NoiseSettings& noise, double frequency);

/// One-sided spectral density of a scenario's noise [Pa²/Hz].
[[nodiscard]] double noise_density(const NoiseSettings& noise, double frequency);

/// Its integral over a band [Pa²]. White noise alone is exact; otherwise Simpson's rule over equal
/// steps of lg f, 64 a decade: within 0.001 dB of the sum of powers. \param low  ≥ 0 [Hz]
[[nodiscard]] double noise_power(const NoiseSettings& noise, double low, double high) noexcept;

/// 10 lg of the same [dB re 1 µPa²] about a centre frequency.
[[nodiscard]] double noise_band_db(const NoiseSettings& noise, double centre,
                                   double width) noexcept;

}  // namespace asdic
