#pragma once
#include <cmath>
#include <complex>

#include "core/units.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// The tube of rays about one of a point source, where it gets to.
struct RayTube {
  double speed = 0.0;            ///< c there [m/s]
  double q = 0.0;                ///< ∂n/∂α, its width in the plane [m/rad]
  double range = 0.0;            ///< r ≥ 0 from the source [m]
  double launch_slowness = 0.0;  ///< ξ₀ = cos α/c₀ ≥ 0, along the horizon at the source [s/m]
  double speed_integral = 0.0;  ///< ∫c ds along the ray [m²/s]
};

/// ξ₀ of a launch. \param elevation  α [rad]   \param source_speed  c₀ [m/s]
[[nodiscard]] inline double launch_slowness(double elevation, double source_speed) noexcept {
  return std::abs(std::cos(elevation)) / source_speed;
}

/// |p| that the tube's area leaves of a unit source at 1 m, losses aside. Power keeps to the tube:
/// from the solid angle cos α·dα·dφ it spreads over |q|·dα·dy, so that
///
///   |p|² = c·ξ₀·dφ/(|q|·dy),   dy = ξ₀·∫c ds·dφ  (plane)   or   r·dφ  (cylindrical).
///
/// In a sea that is the same across the plane the slowness across it, η = ξ₀·dφ, is conserved, and
/// dy/ds = c·η. Infinite at a caustic, where q = 0. docs/theory/rays.md
[[nodiscard]] inline double tube_amplitude(Spreading spreading, const RayTube& tube) noexcept {
  if (spreading == Spreading::plane)
    return std::sqrt(tube.speed / (tube.speed_integral * std::abs(tube.q)));
  return std::sqrt(tube.speed * tube.launch_slowness / (tube.range * std::abs(tube.q)));
}

/// The least |dr/dξ| [m²/s] that boundary paths keep beside a caustic: below it rays are no longer
/// resolved. With r = r_c + ½r″(ξ − ξ_c)² two rays differ in time by (4√2/3)δ^{3/2}/√|r″|, Airy's
/// argument is ζ = (3ωΔτ/4)^{2/3}, and the largest Airy amplitude 2√π·Ai(−1.019) ζ^{1/4} A, shared
/// by two rays adding at random, is reached by each at ζ = 0.307. Eigenrays that roots find are not
/// held (their floor is 0): raytrace/waves/caustics.h says what sound they stand for there.
/// \param curvature  |r″| = |d²r/dξ²| where r′ = 0 [m³/s²]   \param frequency  [Hz]
[[nodiscard]] inline double airy_floor(double curvature, double frequency) noexcept {
  constexpr double zeta = 0.307;
  return std::cbrt(2.0) * std::sqrt(zeta) * std::pow(curvature, 2.0 / 3.0) /
         std::cbrt(2.0 * pi * frequency);
}

/// e^{+iπ/2} for every caustic. \param caustics  below 0: so many are taken back
[[nodiscard]] inline std::complex<double> caustic_phase(int caustics) noexcept {
  constexpr std::complex<double> quarter_turns[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  return quarter_turns[caustics & 3];
}

/// Pressure at the end of a path from a unit source at 1 m [1/m × 1 m]. docs/theory/eigenrays.md
/// \param spreading  tube_amplitude()   \param absorbed  what absorption leaves of a pressure,
/// e^−nepers = 10^(−dB/20)   \param reflection  product of the boundaries' coefficients
[[nodiscard]] inline std::complex<double> path_amplitude(double spreading, double absorbed,
                                                         std::complex<double> reflection,
                                                         int caustics) noexcept {
  return spreading * absorbed * reflection * caustic_phase(caustics);
}

/// Mean square pressure that rough boundaries scattered about the path, Arrival::scattered
/// [1/m² × 1 m²]. \param share  of the energy that falls on them
[[nodiscard]] inline double scattered_power(double spreading, double absorbed,
                                            double share) noexcept {
  const double size = spreading * absorbed;
  return size * size * share;
}

}  // namespace asdic::detail
