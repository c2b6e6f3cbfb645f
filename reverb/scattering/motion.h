#pragma once
#include <cmath>
#include <span>
#include <string_view>

#include "core/units.h"

namespace asdic::detail {

class Fields;

/// How the scatterers of one boundary or layer move.
struct ScattererMotion {
  enum class Kind {
    still,  ///< with the current alone
    bragg,  ///< the wave that scatters travels: the lines ±√(gQ)/2π, Q the horizontal wavenumber
            ///< of the scattering
    spread,  ///< every scatterer has a velocity of its own, Gaussian
  };
  Kind kind = Kind::still;
  double receding_share = 0.5;  ///< of the Bragg waves, those that lower the frequency, 0..1
  double speed_rms = 0.0;       ///< of each component of a scatterer's velocity [m/s]
  Vec2 current = Vec2::Zero();  ///< east, north [m/s]; the whole field drifts with it

  void describe(Fields& field);
};
inline constexpr std::string_view scatterer_motion_words[] = {"still", "bragg", "spread"};
constexpr std::span<const std::string_view> words(ScattererMotion::Kind /*any*/) {
  return scatterer_motion_words;
}

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
