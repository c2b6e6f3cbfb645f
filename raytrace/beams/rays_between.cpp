#include "raytrace/beams/rays_between.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "raytrace/beams/larger.h"

namespace asdic::detail {
namespace {

/// How far two outer rays may be off the middle one: radians of phase, shares of width and level.
/// Rays between any two of the three are nearer: 16 times where cubics tell them (places, delays),
/// some five where lines told the middle one and parabolas tell them, eight where parabolas told it
/// at columns that a reflection parts, four where tangents did.
constexpr double by_cubics = 0.1, by_lines = 0.04, parted_by = 0.04;
/// Where one ray crosses fewer columns, what is left of it after reflections does not count.
constexpr double next_to_nothing = 1e-3;

/// To within half a turn.
double wrapped(double angle) noexcept {
  return angle - 2.0 * pi * std::floor(angle / (2.0 * pi) + 0.5);
}

/// Of two neighbours, whether more than one reflection parts them.
bool far_apart(const Crossings& a, const Crossings& b, std::size_t k) noexcept {
  return a.bounces[k] != b.bounces[k] && a.mirror[k] == b.mirror[k];
}

bool same_history(const Crossings& a, const Crossings& b, std::size_t k) noexcept {
  return a.bounces[k] == b.bounces[k] && (a.q[k] < 0.0) == (b.q[k] < 0.0) &&
         std::abs(wrapped(a.phase[k] - b.phase[k])) < 0.5;
}

}  // namespace

RaysBetween::RaysBetween(const PropagationCase& run_case)
    : omega_(2.0 * pi * run_case.frequency),
      is_hat_(run_case.beams.kind == BeamKind::hat),
      coherent_(run_case.field == FieldKind::coherent) {
  for (const double range : run_case.receivers.ranges) {
    const auto at = [&](const Boundary& boundary) {
      return Wall{boundary.depth_at(range), boundary.shape ? boundary.shape->at(range).slope : 0.0};
    };
    surface_.push_back(at(run_case.environment.surface));
    bottom_.push_back(at(run_case.environment.bottom));
  }
}

RaysBetween::Place RaysBetween::place(const Traced& ray, std::size_t k) noexcept {
  const Crossings& x = ray.crossings;
  return {x.depth[k], x.cosine[k], x.sine[k],  x.speed[k], x.time[k],
          x.q[k],     x.dq_ds[k],  x.level[k], x.phase[k], x.mirror[k]};
}

bool RaysBetween::in_water(std::size_t column, double depth) const noexcept {
  return depth >= surface_[column].depth && depth <= bottom_[column].depth;
}

/// ∂z/∂α of a ray at its column.
double RaysBetween::depth_slope(const Place& x) noexcept { return -x.mirror * x.q / x.cosine; }

RaysBetween::Place RaysBetween::beside(const Traced& ray, const Traced& other, std::size_t k,
                                       double elevation) const noexcept {
  const Place x = place(ray, k);
  Place y = place(other, k), at = x;
  const double d = elevation - ray.elevation, t = d / (other.elevation - ray.elevation);
  if (x.mirror != y.mirror) {  // as it would be had it gone on, or were yet to be reflected
    const std::uint32_t a = ray.crossings.bounces[k], b = other.crossings.bounces[k];
    const std::size_t column = ray.crossings.column[k];
    const double m = (a >> 16U != b >> 16U ? surface_ : bottom_)[column].slope;
    const double cosine = ((1.0 - m * m) * y.cosine + 2.0 * m * y.sine) / (1.0 + m * m);
    y.sine = (2.0 * m * y.cosine - (1.0 - m * m) * y.sine) / (1.0 + m * m);
    y.cosine = cosine, y.mirror = x.mirror;
  }
  const double zx = depth_slope(x), zy = depth_slope(y);
  const double tx = zx * x.sine / x.speed, ty = zy * y.sine / y.speed;
  at.depth += d * (zx + 0.5 * t * (zy - zx));
  at.time += d * (tx + 0.5 * t * (ty - tx));
  at.sine = std::clamp(x.sine + t * (y.sine - x.sine), -1.0, 1.0);
  at.cosine = std::copysign(std::sqrt(1.0 - at.sine * at.sine), x.cosine);
  if ((x.q < 0.0) == (y.q < 0.0)) at.q += t * (y.q - x.q);
  return at;
}

RaysBetween::Place RaysBetween::between(const Traced& a, const Traced& b, std::size_t k,
                                        double elevation) const noexcept {
  const Crossings &xa = a.crossings, &xb = b.crossings;
  const Place pa = place(a, k), pb = place(b, k);
  const double h = b.elevation - a.elevation, t = (elevation - a.elevation) / h;
  const bool smooth = same_history(xa, xb, k), caustic = (pa.q < 0.0) != (pb.q < 0.0);
  if (xa.bounces[k] != xb.bounces[k] || (!smooth && !caustic)) {
    const Place from_a = beside(a, b, k, elevation);
    const Place from_b = beside(b, a, k, elevation);
    const std::size_t column = xa.column[k];
    const bool a_there = in_water(column, from_a.depth), b_there = in_water(column, from_b.depth);
    return a_there == b_there ? (t < 0.5 ? from_a : from_b) : (a_there ? from_a : from_b);
  }
  const double s = 1.0 - t, hermite_a = (1.0 + 2.0 * t) * s * s,
               hermite_b = (3.0 - 2.0 * t) * t * t;
  const double slope_a = h * t * s * s, slope_b = -h * t * t * s;
  const double za = depth_slope(pa), zb = depth_slope(pb);
  Place at{};
  at.mirror = pa.mirror;
  at.depth = hermite_a * pa.depth + hermite_b * pb.depth + slope_a * za + slope_b * zb;
  at.time = hermite_a * pa.time + hermite_b * pb.time + slope_a * za * pa.sine / pa.speed +
            slope_b * zb * pb.sine / pb.speed;
  const auto through = [&](double fa, double fb) { return fa + t * (fb - fa); };
  at.sine = std::clamp(through(pa.sine, pb.sine), -1.0, 1.0);
  at.cosine = std::copysign(std::sqrt(1.0 - at.sine * at.sine), pa.cosine);
  at.speed = through(pa.speed, pb.speed);
  at.q = through(pa.q, pb.q);
  at.dq_ds = through(pa.dq_ds, pb.dq_ds);
  at.level = std::max(through(pa.level, pb.level), 0.0);
  if (smooth)
    at.phase = pa.phase + t * wrapped(pb.phase - pa.phase);
  else
    at.phase = (at.q < 0.0) == (pa.q < 0.0) ? pa.phase : pb.phase;
  return at;
}

bool RaysBetween::foretold(const Place& said, const Place& is, bool smooth) const noexcept {
  const double k = omega_ / is.speed;
  const double least =
      is_hat_ ? 0.0 : std::min(0.1 / pi * omega_ * is.time, 2.0 * pi * pi * is.speed / omega_);
  const double width = std::max({std::abs(is.q) * spacing_, least, 1e-6});
  const double miss = said.depth - is.depth;
  const double most_off = smooth ? by_cubics : parted_by,
               most_changed = smooth ? by_lines : parted_by;
  if (!(std::abs(miss * is.cosine) < most_off * width)) return false;
  if (said.mirror != is.mirror) return true;  // both at the boundary where they part
  if (!(std::abs(said.level - is.level) < most_changed * std::max(is.level, next_to_nothing)))
    return false;
  if (!(std::abs(said.q - is.q) * spacing_ < most_changed * width)) return false;
  if (!coherent_) return true;
  const double across = k * width * std::abs(said.sine - is.sine);
  if (!(across < most_changed)) return false;
  if ((said.q < 0.0) != (is.q < 0.0)) return true;  // at a caustic, or nearly
  const double turn = std::abs(wrapped(said.phase - is.phase) - omega_ * (said.time - is.time) +
                               k * is.sine * miss);
  return turn < most_off;
}

bool RaysBetween::fit(const Traced& lowest, const Traced& middle, const Traced& highest,
                      double spacing) {
  spacing_ = spacing;
  const Crossings &a = lowest.crossings, &m = middle.crossings, &b = highest.crossings;
  size_ = std::min({a.size(), m.size(), b.size()});
  if (size_ == 0) return false;
  for (const Crossings* x : {&a, &m, &b}) {
    if (x->size() > size_ && x->level[size_] > next_to_nothing) return false;
    if (!std::equal(x->column.begin(), x->column.begin() + static_cast<std::ptrdiff_t>(size_),
                    a.column.begin()))
      return false;
  }
  for (std::size_t k = 0; k < size_; ++k)
    if (far_apart(a, m, k) || far_apart(m, b, k) ||
        !foretold(between(lowest, highest, k, middle.elevation), place(middle, k),
                  same_history(a, m, k) && same_history(m, b, k)))
      return false;
  low_ = &lowest, middle_ = &middle, high_ = &highest;
  halves_[0].fit(lowest, middle, highest, size_);
  halves_[1].fit(middle, highest, lowest, size_);
  return true;
}

void RaysBetween::at(double elevation, Crossings& out) const {
  const bool lower = elevation < middle_->elevation;
  const Half& half = halves_[lower ? 0 : 1];
  half.at(elevation, out);
  const Traced &a = lower ? *low_ : *middle_, &b = lower ? *middle_ : *high_;
  for (const std::size_t k : half.parted()) {
    const Place x = between(a, b, k, elevation);
    out.depth[k] = x.depth, out.cosine[k] = x.cosine, out.sine[k] = x.sine;
    out.speed[k] = x.speed, out.time[k] = x.time, out.q[k] = x.q, out.dq_ds[k] = x.dq_ds;
    out.level[k] = x.level, out.phase[k] = x.phase, out.mirror[k] = x.mirror;
  }
}

void RaysBetween::Half::fit(const Traced& a, const Traced& b, const Traced& third,
                            std::size_t size) {
  const Crossings &xa = a.crossings, &xb = b.crossings, &xc = third.crossings;
  begin_ = a.elevation, width_ = b.elevation - a.elevation, like_ = &xa, size_ = size;
  coefficients_.resize(numbers * size);
  parted_.clear();
  const double h = width_, to_third = third.elevation - b.elevation,
               whole = third.elevation - a.elevation;
  double* c = coefficients_.data();
  for (std::size_t k = 0; k < size; ++k) {
    if (!same_history(xa, xb, k)) {
      parted_.push_back(k);
      for (std::size_t i = 0; i < numbers; ++i) c[i * size + k] = 0.0;
      continue;
    }
    std::size_t i = 0;
    const auto cubic = [&](double fa, double fb, double slope_a, double slope_b) {
      c[i++ * size + k] = fa;
      c[i++ * size + k] = h * slope_a;
      c[i++ * size + k] = 3.0 * (fb - fa) - h * (2.0 * slope_a + slope_b);
      c[i++ * size + k] = h * (slope_a + slope_b) - 2.0 * (fb - fa);
    };
    const double za = depth_slope(place(a, k)), zb = depth_slope(place(b, k));
    cubic(xa.depth[k], xb.depth[k], za, zb);
    cubic(xa.time[k], xb.time[k], za * xa.sine[k] / xa.speed[k], zb * xb.sine[k] / xb.speed[k]);
    const double like = same_history(xa, xc, k) && same_history(xb, xc, k) ? 1.0 : 0.0;
    const auto parabola = [&](double fa, double fb, double fc) {
      const double bend = like * h * h / whole * ((fc - fb) / to_third - (fb - fa) / h);
      c[i++ * size + k] = fa;
      c[i++ * size + k] = fb - fa - bend;
      c[i++ * size + k] = bend;
    };
    parabola(xa.sine[k], xb.sine[k], xc.sine[k]);
    parabola(xa.speed[k], xb.speed[k], xc.speed[k]);
    parabola(xa.q[k], xb.q[k], xc.q[k]);
    parabola(xa.dq_ds[k], xb.dq_ds[k], xc.dq_ds[k]);
    parabola(xa.level[k], xb.level[k], xc.level[k]);
    parabola(xa.phase[k], xa.phase[k] + wrapped(xb.phase[k] - xa.phase[k]),
             xa.phase[k] + wrapped(xc.phase[k] - xa.phase[k]));
  }
}

void RaysBetween::Half::at(double elevation, Crossings& out) const {
  const std::size_t n = size_;
  const double t = (elevation - begin_) / width_;
  out.resize(n);
  out.source_speed = like_->source_speed;
  std::copy_n(like_->column.begin(), n, out.column.begin());
  std::copy_n(like_->mirror.begin(), n, out.mirror.begin());
  const double* c = coefficients_.data();
  for (auto* to : {&out.depth, &out.time}) {
    double* f = to->data();
    ASDIC_INDEPENDENT
    for (std::size_t k = 0; k < n; ++k)
      f[k] = c[k] + t * (c[n + k] + t * (c[2 * n + k] + t * c[3 * n + k]));
    c += 4 * n;
  }
  for (auto* to : {&out.sine, &out.speed, &out.q, &out.dq_ds, &out.level, &out.phase}) {
    double* f = to->data();
    ASDIC_INDEPENDENT
    for (std::size_t k = 0; k < n; ++k) f[k] = c[k] + t * (c[n + k] + t * c[2 * n + k]);
    c += 3 * n;
  }
  const double* like = like_->cosine.data();
  double *sine = out.sine.data(), *cosine = out.cosine.data(), *level = out.level.data();
  ASDIC_INDEPENDENT
  for (std::size_t k = 0; k < n; ++k) {
    sine[k] = beams::larger(-1.0, beams::smaller(1.0, sine[k]));
    level[k] = beams::larger(0.0, level[k]);
    cosine[k] = std::copysign(std::sqrt(1.0 - sine[k] * sine[k]), like[k]);
  }
}

}  // namespace asdic::detail
