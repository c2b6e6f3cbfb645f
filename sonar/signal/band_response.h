#pragma once
#include <complex>
#include <span>
#include <vector>

#include "core/units.h"

namespace asdic::detail {

/// What makes a return's amplitude a function of frequency: how far it went, and where its path
/// left the transmitter.
struct PathResponse {
  double path_length = 0.0;                    ///< there and back [m]
  double bearing = 0.0;                        ///< of launch [rad]
  double elevation = 0.0;                      ///< of launch, positive up [rad]
  std::complex<double> without_pattern = 0.0;  ///< amplitude before the transmitter's pattern
};

/// A band served by a few frequencies: any response is A(f) ≈ Σ_k ℓ_k(f)·A(f_k), f_k Chebyshev
/// points, ℓ_k Lagrange's polynomials.
struct BandNodes {
  double centre = 0.0, half_width = 0.0;  ///< [Hz]
  std::vector<double> frequencies;        ///< f_k [Hz]

  /// ℓ_k(f). \param frequency  [Hz]
  [[nodiscard]] double basis(std::size_t k, double frequency) const noexcept {
    return product(k, frequency) / product(k, frequencies[k]);
  }
  /// Π (f − f_j) over the other nodes, in units of half the half width: ℓ_k(f) but for a factor.
  [[nodiscard]] double product(std::size_t k, double frequency) const noexcept;
};

/// A band with so many Chebyshev points.
[[nodiscard]] BandNodes chebyshev_nodes(double centre, double half_width, std::size_t count);

/// The least number of nodes that interpolates e^{(−b + iz)x}, |x| ≤ 1, to `error`.
///
/// On the ellipse with half axes (ρ ± 1/ρ)/2 it is at most M = e^{b(ρ + 1/ρ)/2 + z(ρ − 1/ρ)/2}, and
/// through K Chebyshev points the error is at most 4Mρ^{1−K}/(ρ − 1) for every ρ > 1. Source:
/// Trefethen, Approximation Theory and Approximation Practice (2013), theorem 8.2.
[[nodiscard]] std::size_t nodes_for(double nepers, double radians, double error);

/// \param nepers  half of what losses change across the band   \param delay  longest between the
/// transmitter's parts [s]
[[nodiscard]] BandNodes band_nodes(double centre, double half_width, double nepers, double delay);

}  // namespace asdic::detail
