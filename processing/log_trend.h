#pragma once
#include <span>

namespace asdic::detail {

/// ln P(z > x) of an exponential value z at time 0 whose mean is e^a, given exponential values z_j
/// at times t_j whose means are e^(a + b·t_j), a and b unknown:
///
///   P = ∫ e^(−b Σt_j) (S(b) + x)^(−m) db / ∫ e^(−b Σt_j) S(b)^(−m) db,   S(b) = Σ z_j e^(−b t_j)
///
/// Uniform over all draws of z_j and z, whatever a, b and t_j: it is the predictive distribution
/// under the right Haar measure da db of a group that the means are moved by (Hora & Buehler, Ann.
/// Math. Stat. 37, 643, 1966). Of b = 0 alone it would be (1 + x/Σz_j)^(−m), Finn & Johnson's.
/// docs/theory/studies.md, eq. (16) \param powers  z_j, above 0   \param times  t_j, two of them
/// different
[[nodiscard]] double log_exceedance_over_trend(std::span<const double> powers,
                                               std::span<const double> times, double x);

}  // namespace asdic::detail
