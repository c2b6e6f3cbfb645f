#pragma once
#include "core/units.h"

namespace asdic::detail {

/// To the nearest integer, for |x| < 2⁵¹; vectorises where std::round does not.
inline double nearest(double x) noexcept {
  constexpr double shift = 0x1.8p52;
  return (x + shift) - shift;
}

/// e^{−i2π·cycles} times (re, im), in place. Sine and cosine of half the angle, |x| ≤ π/2, by their
/// Taylor series to x¹⁵ and x¹⁶ (below 1e-11), then doubled: no branches.
inline void rotate_back(double cycles, double& re, double& im) noexcept {
  const double x = pi * (cycles - nearest(cycles));
  const double y = x * x;
  const double s =
      x * (1.0 + y * (-1.0 / 6 +
                      y * (1.0 / 120 +
                           y * (-1.0 / 5040 +
                                y * (1.0 / 362880 + y * (-1.0 / 39916800 +
                                                         y * (1.0 / 6227020800.0 +
                                                              y * (-1.0 / 1307674368000.0))))))));
  const double c =
      1.0 +
      y * (-0.5 + y * (1.0 / 24 +
                       y * (-1.0 / 720 +
                            y * (1.0 / 40320 + y * (-1.0 / 3628800 +
                                                    y * (1.0 / 479001600.0 +
                                                         y * (-1.0 / 87178291200.0 +
                                                              y * (1.0 / 20922789888000.0))))))));
  const double cosine = c * c - s * s, sine = 2.0 * s * c;
  const double rotated = re * cosine + im * sine;
  im = im * cosine - re * sine;
  re = rotated;
}

}  // namespace asdic::detail
