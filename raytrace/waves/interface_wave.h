#pragma once
#include <complex>
#include <vector>

#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// A wave along a boundary that is slower than sound in the water beside it (Scholte's wave,
/// bending waves of ice): a pole of the plane-wave reflection R at ξ beyond k = ω/c. No ray stands
/// for it. docs/theory/waves.md, "Waves along the boundaries"
struct InterfaceWave {
  std::complex<double> wavenumber;  ///< ξ [1/m]
  std::complex<double> decay;       ///< away from the boundary, γ = √(ξ² − k²) [1/m]
  std::complex<double> residue;     ///< of R(ξ) [1/m]
};

/// Waves along one boundary of which at least −60 dB are left at both ends together.
/// \param ocean  as it is at the source, uniform beside the boundary
/// \param away  both ends' distances from the boundary, their sum [m]
[[nodiscard]] std::vector<InterfaceWave> interface_waves(const Environment& ocean,
                                                         const Boundary& boundary, double frequency,
                                                         double away);

/// Pressure of the waves along surface and floor at 1 m of a source's pressure 1 [1/m × 1 m]:
///
///   |p| = π (ξ/γ) |Res R| √(2/(πξr)) e^{−γ(h₁ + h₂) + Im ξ r},
///
/// h₁ and h₂ the distances of both ends from the boundary.
/// \param range  [m]   \return the root of the sum of squares
[[nodiscard]] double interface_wave_pressure(const Environment& ocean, double source_depth,
                                             double receiver_depth, double range, double frequency);

}  // namespace asdic::detail
