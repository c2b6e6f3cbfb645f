#pragma once
#include <span>

#include "study/summary/intervals.h"

namespace asdic::detail::study {

/// What errors of two components scatter like: NaN of fewer than three.
struct ErrorEllipse {
  double count = 0.0;
  double mean_x = 0.0, mean_y = 0.0;  ///< their bias
  Interval mean_x_interval, mean_y_interval;
  double major = 0.0, minor = 0.0;  ///< half the axes
  Interval major_interval, minor_interval;
  double bearing = 0.0;       ///< of the major axis from y to x, 0 up to π [rad]
  double bearing_half = 0.0;  ///< half of its interval, at most π/2 [rad]
  double inside = 0.0;        ///< share of these errors within it
  double rms = 0.0;           ///< root of the mean square of the errors' lengths
};

/// The ellipse about the mean within which the next error is with probability c, of normal errors.
///
/// With the covariance S of n errors T² = n/(n + 1)·(e − ē)ᵀS⁻¹(e − ē) is 2(n − 1)/(n − 2) times
/// a variate of F(2, n − 2) (Hotelling, Ann. Math. Stat. 2, 360, 1931), whose quantile is
/// (n − 2)/2·((1 − c)^{−2/(n−2)} − 1). Hence half axes r√λ, λ the eigenvalues of S, with
///
///   r² = (n² − 1)/n·((1 − c)^{−2/(n−2)} − 1)   → −2 ln(1 − c) of many
///
/// Of any errors the variance of λ is (E[u⁴] − λ²)/n, u the error along its axis, and that of the
/// axis' bearing E[u²v²]/(n(λ₁ − λ₂)²), to first order: intervals of the axes are r√λ·e^{±½zσ_λ/λ}.
/// docs/theory/studies.md   \param confidence  c, of the ellipse and of all intervals
[[nodiscard]] ErrorEllipse error_ellipse(std::span<const double> x, std::span<const double> y,
                                         double confidence);

}  // namespace asdic::detail::study
