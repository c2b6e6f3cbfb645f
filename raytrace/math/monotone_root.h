#pragma once
#include <cmath>

#include "raytrace/math/hermite.h"

namespace asdic::detail {

/// Where a cubic that rises, or falls, from `low` to `high` has a value: Newton's method inside a
/// shrinking bracket, from a guess, until the value is met to a tolerance.
[[nodiscard]] inline double monotone_root(const Hermite& cubic, double wanted, double low,
                                          double high, bool rising, double guess,
                                          double tolerance) noexcept {
  double x = guess;
  for (int i = 0; i < 40; ++i) {
    const double off = cubic.value(x) - wanted;
    if (std::abs(off) < tolerance) break;
    ((off < 0.0) == rising ? low : high) = x;
    const double slope = cubic.slope(x);
    double next = slope != 0.0 ? x - off / slope : low;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    x = next;
  }
  return x;
}

}  // namespace asdic::detail
