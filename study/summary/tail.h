#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "study/summary/intervals.h"
#include "study/summary/k_shape.h"

namespace asdic::detail::study {

/// A generalised Pareto law over a threshold, fitted to counts in levels (peaks over threshold:
/// Pickands, Ann. Stat. 3, 119, 1975; Davison & Smith, JRSS B 52, 393, 1990):
///
///   P(level ≥ u) = ζ(1 + ξ(u − u₀)/σ)^(−1/ξ),   e^(−(u − u₀)/σ) of ξ = 0
///
/// by the likelihood of the counts themselves, so that how wide levels are makes no error.
/// docs/theory/studies.md, eq. (14)
struct Tail {
  bool fitted = false;         ///< false: too few cells rise over anything
  double from = 0.0;           ///< u₀, a level
  double count = 0.0;          ///< cells at or above it
  double worth = 0.0;          ///< as many independent ones
  double share = 0.0;          ///< ζ
  double shape = 0.0;          ///< ξ
  Interval shape_interval{};   ///< by the likelihood's ratio
  double scale = 1.0;          ///< σ
  double goodness = 0.0;       ///< P of at least this Anderson–Darling statistic if it is the law
  double half_of_share = 0.0;  ///< of ln ζ's interval

  /// ξ and the least and greatest σ with it, as likely as the interval's level asks for.
  struct Likely {
    double shape = 0.0, least = 0.0, greatest = 0.0;
  };
  std::vector<Likely> likely{};

  /// P(level ≥ u), u at or above `from`.
  [[nodiscard]] double rate(double u) const noexcept;
  /// Its interval: all rates of laws that are likely, and what ζ is not known to.
  [[nodiscard]] Interval interval(double u) const noexcept;
};

/// The threshold is the highest level with 2000 cells' worth at or above it, or where there are
/// fewer, a twentieth of all; not fitted below 50. \param levels  lower ends, the last without
/// upper \param counts  cells in each   \param dispersion  [levels] variance of the count at or
/// above a level over that of independent cells
[[nodiscard]] Tail fit_tail(std::span<const double> levels, std::span<const double> counts,
                            std::span<const double> dispersion, double confidence,
                            bool goodness = true);

/// P(level ≥ u), far over what was counted: all that the tail's interval has, and all K
/// distributions that are as likely. For a generalised Pareto law that is fitted to spiky cells
/// bends less than they do further out. \param cells  as of k_exceedance
[[nodiscard]] Interval far_interval(const Tail& tail, const ShapeFit& shape, double u,
                                    double cells);

}  // namespace asdic::detail::study
