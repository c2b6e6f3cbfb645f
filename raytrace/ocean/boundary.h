#pragma once
#include <complex>
#include <string_view>
#include <variant>

namespace asdic {

/// Pressure release: R = −1. The sea surface, seen from below.
struct Vacuum {
  static constexpr std::string_view name = "vacuum";
};

/// Nothing moves: R = +1.
struct Rigid {
  static constexpr std::string_view name = "rigid";
};

/// A homogeneous fluid below (or above) the water. Defaults: sand.
struct FluidHalfSpace {
  static constexpr std::string_view name = "fluid";
  double speed = 1650.0;                       ///< [m/s]
  double density = 1900.0;                     ///< [kg/m³]
  double attenuation_db_per_wavelength = 0.8;  ///< [dB/λ]
};

using BoundaryMaterial = std::variant<Vacuum, Rigid, FluidHalfSpace>;

/// The water beside a boundary.
struct WaterAtBoundary {
  double speed = 1500.0;    ///< [m/s]
  double density = 1000.0;  ///< [kg/m³]
};

/// Plane-wave pressure reflection coefficient, time dependence e^{+iωt}.
///
///   R = (m·sin θ − s)/(m·sin θ + s),  m = ρ₂/ρ₁,  n = (c₁/c₂)(1 − iα/54.575),
///   s = √(n² − cos²θ), Im s ≤ 0 (decaying away from the boundary)
///
/// α in dB per wavelength, 54.575 = 40π·log₁₀e. Never above 1 in magnitude. Jensen et al.,
/// Computational Ocean Acoustics (2011), §1.6; docs/theory/boundaries.md. \param grazing  angle
/// between ray and boundary [rad], 0..π/2
[[nodiscard]] std::complex<double> reflection_coefficient(const BoundaryMaterial& material,
                                                          double grazing,
                                                          const WaterAtBoundary& water) noexcept;

}  // namespace asdic
