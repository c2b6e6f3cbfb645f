#pragma once
#include <cmath>

namespace asdic::detail {

/// I₀(β√(1 − x²))/I₀(β), 0 beyond |x| = 1: the window of interpolators. Kaiser & Schafer, IEEE
/// Trans. ASSP 28, 105 (1980). \param x  0 at the middle, ±1 at the edges
[[nodiscard]] inline double kaiser_window(double x, double beta) {
  const double inside = 1.0 - x * x;
  if (inside < 0.0) return 0.0;
  return std::cyl_bessel_i(0.0, beta * std::sqrt(inside)) / std::cyl_bessel_i(0.0, beta);
}

}  // namespace asdic::detail
