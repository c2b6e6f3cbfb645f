#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "sonar/paths/return_source.h"
#include "sonar/signal/band_limited_pulse.h"
#include "sonar/synthesis/doppler_ridge.h"

namespace asdic::detail {

/// A segment of Doppler factors served by a few stretched pulses: s₊(ηu) ≈ Σ_m ℓ_m(η) s₊(η_m u).
struct DopplerBand {
  double lowest = 1.0, highest = 1.0;
  std::vector<double> nodes;        ///< η_m, Chebyshev points of [lowest, highest]
  std::vector<double> barycentric;  ///< their weights, (−1)^m sin θ_m
  double ridge = 0.0;               ///< κ, along which impulses are moved [s]

  [[nodiscard]] double middle() const noexcept { return 0.5 * (lowest + highest); }
  /// How much later than its pulse's middle a return's impulse is gridded: κ·(η − η_c) [s].
  [[nodiscard]] double late(double doppler) const noexcept { return ridge * (doppler - middle()); }
  /// By how much the impulse is turned then, and its pulse back [cycles]: with the tone of the
  /// band's middle the moved pulses differ the least.
  [[nodiscard]] double rotation(double doppler, double carrier) const noexcept {
    return carrier * (middle() - 1.0) * late(doppler);
  }

  /// ℓ_m(η): Lagrange's polynomials in barycentric form. \param weights [nodes.size()]
  void weights(double doppler, std::span<float> weights) const noexcept;
};

/// A stretched pulse, and where it stands to its impulse.
struct DopplerNode {
  double doppler = 1.0;
  double late = 0.0;      ///< by which the impulse is later than the pulse's middle [s]
  double rotation = 0.0;  ///< by which the pulse is turned back [cycles]
};

/// How many Chebyshev nodes a span of factors needs.
///
/// e^{izx} on [−1, 1] through N points errs by at most 4Σ_{n≥N}|J_n(z)|; a pulse at distance u from
/// its middle has z = 2πf·½span·|u| and the weight of its envelope there. Source: Trefethen,
/// Approximation Theory and Approximation Practice (2013), ch. 7–8; docs/theory/synthesis.md.
class DopplerExpansion {
 public:
  explicit DopplerExpansion(const BandLimitedPulse& pulse);

  /// \param span  highest − lowest factor   \return nodes for an error below −90 dB of the peak
  [[nodiscard]] std::size_t nodes_needed(double span) const;

  /// Covers the factors by the cheapest set of bands found: gaps are skipped, and a few distinct
  /// factors get a node each. \param dopplers in any order \return bands in rising order
  [[nodiscard]] std::vector<DopplerBand> bands(std::vector<double> dopplers) const;
  /// Covers segments of factors, which may overlap. \return bands in rising order
  [[nodiscard]] std::vector<DopplerBand> bands_over(std::vector<DopplerSpan> spans) const;

  /// Cuts bands into narrower ones, with more nodes in all but fewer for each return, as long as
  /// that is cheaper. \param returns  how many there are   \param grid_cost  what one more node
  /// costs, counted in returns gridded for one node   \param ridge  along which impulses may be
  /// moved, to its error; none: not
  [[nodiscard]] std::vector<DopplerBand> cut(std::vector<DopplerBand> bands, double returns,
                                             double grid_cost,
                                             const DopplerRidge* ridge = nullptr) const;

 private:
  struct EnvelopePoint {
    double time, amplitude;
  };
  std::vector<EnvelopePoint> envelope_;
  double highest_frequency_ = 0.0;
};

}  // namespace asdic::detail
