#pragma once
#include "core/units.h"
#include "sonar/scenario/target.h"

namespace asdic::detail {

/// κ of the gamma law, with mean 1, of a target's power from ping to ping: ∞ of a steady one, 1 of
/// Swerling 1 and 2 (exponential), 2 of Swerling 3 and 4.
[[nodiscard]] double fluctuation_shape(Fluctuation fluctuation) noexcept;

/// Probability that an echo is detected whose matched filter's power is compared with its
/// background.
///
/// T = |y|²/b, with y complex Gaussian about the echo's own y, and b the background's mean, known
/// or averaged over m independent free cells. In noise alone the threshold is passed with
/// probability P_fa; with an echo of SNR S = |y_echo|²/E|y_noise|²
///
///   P_d = Σ_j e^{−S} S^j/j! · C_j,   C_j = Σ_{i ≤ j} w_i
///   w_i = x^i e^{−x}/i!,  x = −ln P_fa               (known: P_d is Marcum's Q₁(√2S, √2x))
///   w_i = (m)_i/i! · q^i (1 − q)^m,  1 − q = P_fa^{1/m}  (averaged: cell averaging, CA-CFAR)
///
/// Where the echo's power fluctuates about its mean by a gamma law of shape κ, the mean over it of
/// Poisson's e^{−S} S^j/j! is (κ)_j/j! · (S/(S + κ))^j (κ/(S + κ))^κ. For κ = 1 and a known
/// background that is P_fa^{1/(1 + S)}. docs/theory/studies.md, eq. (10).
/// \param snr  S, a ratio; its mean   \param cells  m; ∞: known   \param shape  κ; ∞: steady
[[nodiscard]] double detection_probability(double snr, double false_alarm_probability, double cells,
                                           double shape = infinity);

/// The SNR at which that probability is reached [dB]. \param probability  above P_fa, below 1
[[nodiscard]] double detection_threshold_db(double false_alarm_probability, double cells,
                                            double probability = 0.5, double shape = infinity);

}  // namespace asdic::detail
