#pragma once
#include "core/arc_series.h"

namespace asdic::detail {

/// A piece that turns so little beyond the edge of its layer that its law is almost a straight
/// line: nodes in it could not be resolved, for c is known to rounding only.
///
/// With c = c_e(1 + …) + g·t + ½c″t² at the distance t from the edge, s² is (2g/c)(T − t)(1 + κ(T +
/// t)/2), T = s_e²/(2ξg), κ = c″/g. An arc of a circle, corrected to the first order in κT:
///
///   r = s/(ξg)·(1 − ⅔κT),  ∂r/∂ξ = −(1 − 2κT)/(ξ²gs),  τ − ξr = (atanh s − s)/g·(1 − ⅖κT),
///   ℓ = asin s/(ξg)·(1 − ⅔κT)
///
/// For a ray (double) or lanes of them.
template <class T>
struct TurnedArc {
  T per_slowness, d_range, intercept, length;  ///< as in SimdLegs

  /// The largest κT: the next order, 0.8(κT)², leaves 2e-11.
  static constexpr double straightest = 5e-6;

  /// Whether the gradient at the edge leads to the turn: not where the law is flat there to the
  /// third order, as PCHIP's can be. s²/(2ξ), the rise of c to the turn, is g times the way to it,
  /// but for c's rounding of 2e-13 m/s. \param way  from the edge to the turn [m]
  static auto reaches(const T& sine, const T& slowness, double gradient, const T& way) noexcept {
    return sine * sine / (2.0 * slowness) <= 2.0 * gradient * way + 1e-11;
  }

  /// \param sine  at the edge, some 1e-3 at most \param gradient  |dc/dz| there \param bend d²c/dz²
  TurnedArc(const T& sine, const T& slowness, double gradient, double bend) noexcept {
    const T s2 = sine * sine;
    const T kt = bend / (2.0 * gradient * gradient) * s2 / slowness;
    const T straight = sine / (slowness * gradient), share = 1.0 - 2.0 / 3.0 * kt;
    per_slowness = straight / slowness * share;
    d_range = (2.0 * kt - 1.0) * straight / (slowness * s2);
    intercept = sine * s2 / gradient * (1.0 / 3.0 + s2 / 5.0) * (1.0 - 0.4 * kt);
    length = straight * asin_series(sine) * share;
  }
};

}  // namespace asdic::detail
