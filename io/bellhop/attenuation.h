#pragma once
#include <optional>

namespace asdic::detail::bellhop {

/// The units in which a BELLHOP case gives attenuation.
enum class AttenuationUnit {
  nepers_per_m,       ///< N
  db_per_m_khz,       ///< F: dB/(m·kHz)
  db_per_m,           ///< M
  db_per_wavelength,  ///< W
  quality,            ///< Q factor; 0: no loss
  loss_parameter,     ///< L: α·c/ω
};

[[nodiscard]] std::optional<AttenuationUnit> attenuation_unit(char letter) noexcept;

inline constexpr double db_per_neper = 8.6858896;  // BELLHOP's; 4e-9 from 20·log₁₀e

/// α [Np/m] of `value` in `unit` for a wave of a speed [m/s] at a frequency [Hz].
[[nodiscard]] double nepers_per_m(AttenuationUnit unit, double value, double speed,
                                  double frequency) noexcept;

/// The same in dB per wavelength; a value in that unit is handed through.
[[nodiscard]] double db_per_wavelength(AttenuationUnit unit, double value, double speed,
                                       double frequency) noexcept;

/// The speed of a wave in our sense, given BELLHOP's. It gives the speed an imaginary part, ω/k =
/// c·(1 + iδ) with δ the nepers in a radian, where ours goes into the wave number, k = (ω/c)·(1 −
/// iδ): the same k belongs to c·(1 + δ²) and the same loss per wavelength.
[[nodiscard]] double true_speed(double speed, double db_per_wavelength) noexcept;

}  // namespace asdic::detail::bellhop
