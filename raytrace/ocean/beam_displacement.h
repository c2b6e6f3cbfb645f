#pragma once
#include "raytrace/ocean/boundary.h"

namespace asdic::detail {

/// How far a beam is carried along a boundary while it is reflected.
struct BeamDisplacement {
  double length = 0.0;       ///< Δ [m], positive in the direction of travel
  double per_grazing = 0.0;  ///< ∂Δ/∂θ at one speed of the water [m/rad]
  double per_speed = 0.0;    ///< ∂Δ/∂c at one grazing angle [m/(m/s)]
};

/// The displacement of a beam by the phase of its reflection coefficient. With R = |R|·e^{iφ},
/// time dependence e^{+iωt} and the wave number k_t = ω·cos θ/c along the boundary, the phase
/// φ − k_t·x of the spectrum is stationary at
///
///   Δ = ∂φ/∂k_t = −(c/ω)·φ_θ/sin θ
///
/// (e^{−iωt}: −∂φ/∂k_t). The delay grows by −∂φ/∂ω at fixed k_t, which is Δ·cos θ/c because every
/// coefficient here depends on the angle alone. Where the magnitude varies with the angle, too,
/// its gradient would make Δ complex: that is left out. Zero at vacuum, rigid walls and the
/// critical angle itself, next to which Δ grows like 1/√|θ − θ_c|. Tindle, JASA 73, 1581 (1983);
/// Brekhovskikh & Lysanov, Fundamentals of Ocean Acoustics; docs/theory/reflections.md.
/// \param grazing [rad] \param frequency [Hz]
[[nodiscard]] BeamDisplacement beam_displacement(const BoundaryMaterial& material, double grazing,
                                                 const WaterAtBoundary& water,
                                                 double frequency) noexcept;

}  // namespace asdic::detail
