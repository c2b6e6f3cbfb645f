#pragma once
#include <array>
#include <cmath>

#include "raytrace/tracing/ray_trajectory.h"

namespace asdic::detail {

/// state_at() of one segment at many places: what depends on the segment alone is worked out once.
class SegmentStates {
 public:
  explicit SegmentStates(const RaySegment& segment) noexcept;

  /// Where the ray is, and how fast that changes along it.
  struct Place {
    double range, depth;
    double range_slope, depth_slope;  ///< along the arc: a tangent, of length 1 but for rounding
  };
  /// \param s  arc length from the segment's begin
  [[nodiscard]] Place place(double s) const noexcept {
    const double u = s * per_h_;
    return {value(range_, u), value(depth_, u), slope(range_, u), slope(depth_, u)};
  }
  [[nodiscard]] RayState at(double s) const noexcept {
    if (per_h_ == 0.0) return begin_;
    const double u = s * per_h_;
    const Place there = place(s);
    const double c = value(c_, u);
    const double unit = 1.0 / (c * std::sqrt(there.range_slope * there.range_slope +
                                             there.depth_slope * there.depth_slope));
    RayState y;
    y.range = there.range, y.depth = there.depth;
    y.xi = there.range_slope * unit, y.zeta = there.depth_slope * unit;
    y.time = value(time_, u);
    y.q = value(q_, u), y.p = slope(q_, u) / c;
    y.q_plane = value(q_plane_, u), y.p_plane = slope(q_plane_, u) / c;
    y.nepers = value(nepers_, u);
    y.length = begin_.length + s;
    y.speed_integral = value(speed_integral_, u);
    return y;
  }

 private:
  using Quintic = std::array<double, 6>;  // in u = s/h
  using Cubic = std::array<double, 4>;

  template <std::size_t n>
  static double value(const std::array<double, n>& a, double u) noexcept {
    double v = a[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) v = a[i] + u * v;
    return v;
  }
  [[nodiscard]] double slope(const Quintic& a, double u) const noexcept {
    return (a[1] + u * (2.0 * a[2] + u * (3.0 * a[3] + u * (4.0 * a[4] + u * 5.0 * a[5])))) *
           per_h_;
  }

  RayState begin_;
  double per_h_ = 0.0;  // 0: a segment without length
  Quintic range_{}, depth_{}, time_{}, q_{}, q_plane_{}, speed_integral_{};
  Cubic c_{}, nepers_{};
};

}  // namespace asdic::detail
