#pragma once
#include "sonar/scenario/noise_settings.h"

namespace asdic::detail {

/// Of the molecules: −15 + 20 lg f_kHz. Mellen, JASA 24, 478 (1952), as Coates fits it.
[[nodiscard]] double thermal_level_db(double frequency) noexcept;

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

}  // namespace asdic::detail
