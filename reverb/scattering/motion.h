#pragma once
#include <cmath>

#include "core/units.h"

namespace asdic::detail {

/// Q [rad/m]: the wavenumber along the surface that the sound takes up when it scatters,
/// |k_i − k_s| in the horizontal, k = 2πf/c. The surface wave of that wavenumber scatters it
/// (Bragg). \param in, out  horizontal slowness vectors of the incident and the scattered sound
/// [s/m]
[[nodiscard]] inline double scattering_wavenumber(const Vec2& in, const Vec2& out,
                                                  double frequency) noexcept {
  return 2.0 * pi * frequency * (in - out).norm();
}

/// √(gQ)/2π [Hz]: the frequency of the deep-water gravity wave of wavenumber Q, by which it shifts
/// the sound that it scatters, up or down as it comes or goes. Barrick, IEEE Trans. Antennas
/// Propag. 20, 2 (1972).
[[nodiscard]] inline double bragg_shift(double wavenumber) noexcept {
  constexpr double gravity = 9.80665;
  return std::sqrt(gravity * wavenumber) / (2.0 * pi);
}

}  // namespace asdic::detail
