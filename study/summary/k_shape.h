#pragma once
#include <span>

namespace asdic::detail::study {

/// P(level ≥ u) of cells whose power is K-distributed of that shape ν, an exponential value of a
/// gamma-distributed mean, over the mean of m such: with t = m(e^(u/m) − 1)
///
///   P = ∫ (1 + t·v/τ)^(−1/v) p_ν(τ) dτ,   v = (1 + 2/ν)/m,
///
/// the mean of m taken for a gamma variable of its own variance v. Of ν → ∞ it is e^(−u).
/// docs/theory/studies.md, eq. (13) \param cells  m; ∞: the background is known
[[nodiscard]] double k_exceedance(double u, double shape, double cells);

struct ShapeFit {
  double shape = 0.0;            ///< ν; ∞: nothing speaks against Rayleigh
  double low = 0.0, high = 0.0;  ///< interval
};

/// The shape of greatest likelihood of counts in levels, and its interval by the likelihood's
/// ratio. NaN of no cells. \param levels  lower ends, the first 0; the last has no upper
/// \param dispersion  variance of the counts over that of independent cells
[[nodiscard]] ShapeFit fit_k_shape(std::span<const double> levels, std::span<const double> counts,
                                   double cells, double dispersion, double confidence);

}  // namespace asdic::detail::study
