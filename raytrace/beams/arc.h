#pragma once
#include <cmath>

#include "core/arc_series.h"

// Of a ray within a layer whose sound speed is linear in depth: an arc of a circle.
namespace asdic::detail {

/// atanh(w)/w as a function of w²: to 5e-11 where w² < 0.1, further than atanh_series goes.
template <class Real>
inline Real atanh_over_w(const Real& w2) noexcept {
  return 1.0 +
         w2 * (1.0 / 3 +
               w2 * (1.0 / 5 +
                     w2 * (1.0 / 7 +
                           w2 * (1.0 / 9 +
                                 w2 * (1.0 / 11 +
                                       w2 * (1.0 / 13 + w2 * (1.0 / 15 + w2 * (1.0 / 17))))))));
}
inline constexpr double series_limit = 0.1;

/// τ over a range Δ within one layer. \param w_over_g  ξΔ/(1 − s_a·s_b)
inline double layer_time(double w_over_g, double g) noexcept {
  const double w = w_over_g * g;
  return w * w < series_limit ? w_over_g * atanh_over_w(w * w) : std::atanh(w) / g;
}

}  // namespace asdic::detail
