#include "raytrace/tracing/ray_trajectory.h"

#include <algorithm>
#include <cmath>

#include "raytrace/tracing/segment_states.h"

namespace asdic::detail {
namespace {

/// Value and slope of the quintic that has value, slope and second derivative f, f', f'' at both
/// ends of an interval of length h; u = s/h.
struct ValueSlope {
  double value, slope;
};

struct Jet {
  double f, d, dd;
};

ValueSlope quintic(const Jet& a, const Jet& b, double h, double u) noexcept {
  // p(u) = a.f + a1 u + a2 u² + a3 u³ + a4 u⁴ + a5 u⁵ in units of h
  const double a1 = a.d * h, a2 = 0.5 * a.dd * h * h;
  const double rise = b.f - a.f - a1 - a2;
  const double slope = b.d * h - a1 - 2.0 * a2;
  const double bend = b.dd * h * h - 2.0 * a2;
  const double a3 = 10.0 * rise - 4.0 * slope + 0.5 * bend;
  const double a4 = -15.0 * rise + 7.0 * slope - bend;
  const double a5 = 6.0 * rise - 3.0 * slope + 0.5 * bend;
  return {a.f + u * (a1 + u * (a2 + u * (a3 + u * (a4 + u * a5)))),
          (a1 + u * (2.0 * a2 + u * (3.0 * a3 + u * (4.0 * a4 + u * 5.0 * a5)))) / h};
}

std::array<double, 6> quintic_terms(const Jet& a, const Jet& b, double h) noexcept {
  const double a1 = a.d * h, a2 = 0.5 * a.dd * h * h;
  const double rise = b.f - a.f - a1 - a2;
  const double slope = b.d * h - a1 - 2.0 * a2;
  const double bend = b.dd * h * h - 2.0 * a2;
  return {a.f,
          a1,
          a2,
          10.0 * rise - 4.0 * slope + 0.5 * bend,
          -15.0 * rise + 7.0 * slope - bend,
          6.0 * rise - 3.0 * slope + 0.5 * bend};
}

ValueSlope evaluate(const std::array<double, 6>& a, double u) noexcept {
  double v = a[5], d = 0.0;
  for (std::size_t i = 5; i-- > 0;) {
    d = v + u * d;
    v = a[i] + u * v;
  }
  return {v, d};
}

std::array<double, 4> cubic_terms(double f0, double d0, double f1, double d1, double h) noexcept {
  const double rise = f1 - f0;
  const double a1 = d0 * h, b1 = d1 * h;
  return {f0, a1, 3.0 * rise - 2.0 * a1 - b1, a1 + b1 - 2.0 * rise};
}

/// One end of a segment with what the equations of motion say about slopes and bends there.
struct SegmentEnd {
  SegmentEnd(const RayState& y, double c, double c_r, double c_z, double c_nn) noexcept
      : tr(c * y.xi), tz(c * y.zeta), c_s(c_r * tr + c_z * tz) {
    const double c_n = -c_r * tz + c_z * tr;  // n = (−t_z, t_r)
    range = {y.range, tr, c_n / c * tz};      // d²x/ds² = −(c_n/c) n
    depth = {y.depth, tz, -c_n / c * tr};
    time = {y.time, 1.0 / c, -c_s / (c * c)};
    q = {y.q, c * y.p, c_s * y.p - c_nn / c * y.q};  // dq/ds = c p, dp/ds = −(c_nn/c²) q
    q_plane = {y.q_plane, c * y.p_plane, c_s * y.p_plane - c_nn / c * y.q_plane};
    speed_integral = {y.speed_integral, c, c_s};
  }
  static SegmentEnd first_of(const RaySegment& s) noexcept {
    return {s.begin, s.c_begin, s.c_r_begin, s.c_z_begin, s.c_nn_begin};
  }
  static SegmentEnd last_of(const RaySegment& s) noexcept {
    return {s.end, s.c_end, s.c_r_end, s.c_z_end, s.c_nn_end};
  }
  double tr, tz, c_s;
  Jet range{}, depth{}, time{}, q{}, q_plane{}, speed_integral{};
};

}  // namespace

SegmentStates::SegmentStates(const RaySegment& segment) noexcept : begin_(segment.begin) {
  const double h = segment.end.length - segment.begin.length;
  if (h <= 0.0) return;
  per_h_ = 1.0 / h;
  const SegmentEnd a = SegmentEnd::first_of(segment), b = SegmentEnd::last_of(segment);
  range_ = quintic_terms(a.range, b.range, h);
  depth_ = quintic_terms(a.depth, b.depth, h);
  time_ = quintic_terms(a.time, b.time, h);
  q_ = quintic_terms(a.q, b.q, h);
  q_plane_ = quintic_terms(a.q_plane, b.q_plane, h);
  speed_integral_ = quintic_terms(a.speed_integral, b.speed_integral, h);
  c_ = cubic_terms(segment.c_begin, a.c_s, segment.c_end, b.c_s, h);
  nepers_ = cubic_terms(segment.begin.nepers, segment.alpha_begin, segment.end.nepers,
                        segment.alpha_end, h);
}

RayState state_at(const RaySegment& segment, double s) noexcept {
  return SegmentStates(segment).at(s);
}

SegmentCurve::SegmentCurve(const RaySegment& segment) noexcept
    : segment_(segment), h_(segment.end.length - segment.begin.length) {
  if (h_ <= 0.0) return;
  const SegmentEnd a = SegmentEnd::first_of(segment), b = SegmentEnd::last_of(segment);
  range_ = quintic_terms(a.range, b.range, h_);
  depth_ = quintic_terms(a.depth, b.depth, h_);
  q_ = quintic_terms(a.q, b.q, h_);
  c_ = cubic_terms(segment.c_begin, a.c_s, segment.c_end, b.c_s, h_);
}

SegmentCurve::Crossing SegmentCurve::at_range(double range) const noexcept {
  const double begin = segment_.begin.range, end = segment_.end.range;
  if (h_ <= 0.0)
    return {segment_.begin.depth, segment_.begin.xi, segment_.begin.zeta, segment_.begin.q};
  const double sense = end > begin ? 1.0 : -1.0;
  double low = 0.0, high = 1.0, u = begin == end ? 0.0 : (range - begin) / (end - begin);
  ValueSlope r = evaluate(range_, u);
  for (int i = 0; i < 60 && begin != end; ++i) {  // Newton's method, bracketed
    const double miss = sense * (r.value - range);
    (miss > 0.0 ? high : low) = u;
    double next = u - miss / (sense * r.slope);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double step = std::abs(next - u) * h_;
    u = next;
    r = evaluate(range_, u);
    if (step < 1e-5) break;  // the next would be of the order of its square over the bend's radius
  }
  const ValueSlope z = evaluate(depth_, u);
  const double c = c_[0] + u * (c_[1] + u * (c_[2] + u * c_[3]));
  const double unit = 1.0 / (c * std::sqrt(r.slope * r.slope + z.slope * z.slope));
  return {z.value, r.slope * unit, z.slope * unit, evaluate(q_, u).value};
}

double arc_at_range(const RaySegment& segment, double range) noexcept {
  const double h = segment.end.length - segment.begin.length;
  const double begin = segment.begin.range, end = segment.end.range;
  if (h <= 0.0 || begin == end || range == begin) return 0.0;
  if (range == end) return h;
  const SegmentEnd a = SegmentEnd::first_of(segment), b = SegmentEnd::last_of(segment);
  const double sense = end > begin ? 1.0 : -1.0;
  double low = 0.0, high = 1.0, u = (range - begin) / (end - begin);
  for (int i = 0; i < 60; ++i) {  // Newton's method, bracketed
    const ValueSlope r = quintic(a.range, b.range, h, u);
    const double miss = sense * (r.value - range);
    (miss > 0.0 ? high : low) = u;
    const double step = miss / (sense * r.slope * h);
    double next = u - step;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const bool done = std::abs(next - u) * h < 1e-11 * (1.0 + h);
    u = next;
    if (done) break;
  }
  return u * h;
}

}  // namespace asdic::detail
