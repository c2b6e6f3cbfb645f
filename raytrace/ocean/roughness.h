#pragma once

namespace asdic {

/// How rough a boundary is: what is left of a mirror's coherent reflection.
///
/// Eckart/Kirchhoff: |R| of the smooth boundary times exp(−G²/2), G = 2 k h sin θ, for Gaussian
/// heights (Eckart, JASA 25, 566, 1953). The rest is scattered, not lost: a bounced path never
/// falls by more than `floor_db` a bounce. docs/theory/boundaries.md, "Roughness"
struct Roughness {
  double rms_height = 0.0;  ///< h [m]; 0: smooth
  double floor_db = -20.0;  ///< the least that a bounce leaves, 20 lg [dB], ≤ 0; −∞: no floor

  [[nodiscard]] bool smooth() const noexcept { return !(rms_height > 0.0); }

  [[nodiscard]] bool operator==(const Roughness&) const = default;
};

/// The factor on the reflection coefficient, 0 … 1. \param sine  of the grazing angle
/// \param wavenumber  k in the water at the boundary [rad/m]
[[nodiscard]] double coherent_reflection(const Roughness& roughness, double sine,
                                         double wavenumber) noexcept;

/// Standard deviation of the surface's height in a fully developed sea, Pierson & Moskowitz:
/// h = 0.0523·(1.026 U)²/g [m], 0.56 m at 10 m/s. \param wind_speed  at 10 m [m/s]
[[nodiscard]] double pierson_moskowitz_height(double wind_speed) noexcept;

}  // namespace asdic
