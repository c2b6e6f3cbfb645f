#pragma once
#include <cmath>

#include "core/units.h"

namespace asdic::detail {

/// sin x/x.
[[nodiscard]] inline double sine_over(double x) noexcept {
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x;
}

/// I₀(β√(1 − x²))/I₀(β), 0 beyond |x| = 1: the window of interpolators. Kaiser & Schafer, IEEE
/// Trans. ASSP 28, 105 (1980). \param x  0 at the middle, ±1 at the edges
[[nodiscard]] inline double kaiser_window(double x, double beta) {
  const double inside = 1.0 - x * x;
  if (inside < 0.0) return 0.0;
  return std::cyl_bessel_i(0.0, beta * std::sqrt(inside)) / std::cyl_bessel_i(0.0, beta);
}

/// A sinc under a Kaiser window of so many taps: what a sample x samples away weighs between the
/// samples of a signal.
[[nodiscard]] inline double windowed_sinc(double x, int taps, double beta) {
  return sine_over(pi * x) * kaiser_window(2.0 * x / taps, beta);
}

}  // namespace asdic::detail
