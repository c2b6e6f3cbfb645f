#include "raytrace/tracing/course.h"

#include <array>
#include <cmath>

namespace asdic::detail::tracing {
namespace {

constexpr double small = 0.2;  // arguments up to which the series below are exact to rounding [rad]

/// sin(x)/x. Series to x¹⁰: the next term is 3e-18 at 0.2.
double sinc(double x) noexcept {
  if (std::abs(x) > small) return std::sin(x) / x;
  const double y = x * x;
  return 1.0 - y / 6.0 *
                   (1.0 - y / 20.0 *
                              (1.0 - y / 42.0 *
                                         (1.0 - y / 72.0 * (1.0 - y / 110.0 * (1.0 - y / 156.0)))));
}

/// cos(x). Series to x¹²: the next term is 2e-21 at 0.2.
double cosine(double x) noexcept {
  if (std::abs(x) > small) return std::cos(x);
  const double y = x * x;
  return 1.0 -
         y / 2.0 *
             (1.0 - y / 12.0 *
                        (1.0 - y / 30.0 * (1.0 - y / 56.0 * (1.0 - y / 90.0 * (1.0 - y / 132.0)))));
}

/// asin(√y)/√y, and with a negative y asinh(√−y)/√−y, for |y| ≤ 0.04: Σ (2n)!/(4ⁿn!²(2n + 1))·yⁿ to
/// n = 10; the next term is 2e-18.
double asinc_series(double y) noexcept {
  constexpr std::array c = {1.0,
                            1.0 / 6.0,
                            3.0 / 40.0,
                            5.0 / 112.0,
                            35.0 / 1152.0,
                            63.0 / 2816.0,
                            231.0 / 13312.0,
                            143.0 / 10240.0,
                            6435.0 / 557056.0,
                            12155.0 / 1245184.0,
                            46189.0 / 5505024.0};
  double sum = c.back();
  for (std::size_t i = c.size() - 1; i-- > 0;) sum = c[i] + y * sum;
  return sum;
}

double asinc(double x) noexcept {
  return std::abs(x) <= small ? asinc_series(x * x) : std::asin(std::min(1.0, x)) / x;
}

double asinhc(double x) noexcept {
  return std::abs(x) <= small ? asinc_series(-x * x) : std::asinh(x) / x;
}

}  // namespace

void Course::begin(const Cell& cell, const RayState& y, const Local& here) noexcept {
  cell_ = &cell;
  y_ = y;
  here_ = here;
  tr_ = here.c * y.xi;
  tz_ = here.c * y.zeta;
  closed_ = true;
  switch (cell.law) {
    case Law::arc:
      bend_ = -here.c_z * y.xi;
      per_metre_ = 1.0;
      return;
    case Law::parabola:
      bend_ = cell.a[1];
      per_metre_ = here.c;
      return;
    case Law::cubic:
    case Law::bilinear:
    case Law::munk:
      closed_ = false;
      per_metre_ = 1.0 / here.c;
  }
}

/// Arc: the direction's angle from the line, ψ, turns evenly, ψ′ = k, and the distance F = F₀ +
/// ∫sin ψ ds = F₀ + (cos ψ₀ − cos ψ)/k. At F = 0: cos ψ₁ = cos ψ₀ + kF₀, sin²ψ₁ = sin²ψ₀ − kF₀(cos
/// ψ₀ + cos ψ₁), without cancellation; the chord is what has been covered across the line, F₀, and
/// along it, (sin ψ₁ − sin ψ₀)/k. Parabola: F = F₀ + S·w + Q·w².
double Course::to_line(const Line& line) const noexcept {
  const double f = line.distance(y_.range, y_.depth);
  if (cell_->law == Law::parabola) {
    const double s = line.nr * y_.xi + line.nz * y_.zeta, q = 0.25 * bend_ * line.nz;
    const double square = s * s - 4.0 * q * f;
    if (!(square >= 0.0)) return never;
    const double root = std::sqrt(square);
    if (s < 0.0) return 2.0 * f / (root - s);
    return q < 0.0 ? -0.5 * (s + root) / q : never;
  }
  const double sin0 = line.nr * tr_ + line.nz * tz_, cos0 = line.nz * tr_ - line.nr * tz_;
  const double k = bend_, cos1 = cos0 + k * f;
  const double square = sin0 * sin0 - k * f * (cos0 + cos1);
  if (!(square >= 0.0)) return never;
  const double sin1 = -std::sqrt(square);
  double along = 0.0;
  if (sin0 < 0.0) {
    along = -f * (cos0 + cos1) / (sin0 + sin1);
  } else {
    if (!(k * cos0 < 0.0)) return never;  // not before it has turned by π/2
    along = (sin1 - sin0) / k;
  }
  const double chord = std::sqrt(f * f + along * along);
  const double turn = std::abs(0.5 * k * chord);
  return turn > small ? never : std::copysign(chord * asinc(turn), sin0 < 0.0 ? f : 1.0);
}

double Course::to_turn() const noexcept {
  if (cell_->law == Law::parabola) return y_.zeta * bend_ < 0.0 ? -2.0 * y_.zeta / bend_ : never;
  // the direction's angle is atan(t_z/|t_r|), and it turns by |k| towards the horizon
  if (!(y_.zeta * bend_ * y_.xi < 0.0) || std::abs(tz_) > 0.3) return never;
  return std::asin(std::abs(tz_)) / std::abs(bend_);
}

double Course::to_range(double range, double begin, double end, double last) const noexcept {
  const double sense = end >= begin ? -1.0 : 1.0;
  const Line line{.range = range, .nr = sense, .nz = 0.0};
  if (closed_) return to_line(line);
  return falling_root(0.0, last, (range - begin) / (end - begin) * last, [&](double h) {
    const auto r = series_.value_and_slope(series_.place, PowerSeries::range, h);
    return ValueSlope{sense * (y_.range + r.value - range), sense * r.slope};
  });
}

Place Course::at(double h) const noexcept {
  switch (cell_->law) {
    case Law::arc: {
      const double x = 0.5 * bend_ * h;
      const double ratio = sinc(x), cos_x = cosine(x), sin_x = x * ratio;
      const double mean_r = tr_ * cos_x - tz_ * sin_x, mean_z = tz_ * cos_x + tr_ * sin_x;
      return {.range = y_.range + h * ratio * mean_r,
              .depth = y_.depth + h * ratio * mean_z,
              .dr = mean_r * cos_x - mean_z * sin_x,
              .dz = mean_z * cos_x + mean_r * sin_x};
    }
    case Law::parabola:
      return {.range = y_.range + y_.xi * h,
              .depth = y_.depth + h * (y_.zeta + 0.25 * bend_ * h),
              .dr = y_.xi,
              .dz = y_.zeta + 0.5 * bend_ * h};
    case Law::cubic:
    case Law::bilinear:
    case Law::munk:
      break;
  }
  const auto [r, z] = series_.where(h);
  return {y_.range + r.value, y_.depth + z.value, r.slope, z.slope};
}

RayState Course::end(double h) const noexcept {
  switch (cell_->law) {
    case Law::arc:
      return end_of_arc(h);
    case Law::parabola:
      return end_of_parabola(h);
    case Law::cubic:
    case Law::bilinear:
    case Law::munk:
      break;
  }
  return end_of_series(h);
}

/// c = c_a + g(z − z_a): the direction turns evenly, φ(s) = φ_a − gξ·s, so the chord has the mean
/// direction and the length s·sin(x)/x, x = −gξs/2.
RayState Course::end_of_arc(double s) const noexcept {
  const RayState& y = y_;
  const double g = here_.c_z, c = here_.c, x = 0.5 * bend_ * s;
  const double ratio = sinc(x), cos_x = cosine(x), sin_x = x * ratio;
  const double chord = s * ratio;
  const double mean_r = tr_ * cos_x - tz_ * sin_x, mean_z = tz_ * cos_x + tr_ * sin_x;
  RayState b = y;
  b.range = y.range + chord * mean_r;
  b.depth = y.depth + chord * mean_z;
  const double cb = c + g * (b.depth - y.depth);
  b.zeta = (mean_z * cos_x + mean_r * sin_x) / cb;  // turned by 2x; ξ is Snell's invariant
  // τ = (2/g)·asinh(g·d/(2√(c_a c_b))), d the chord
  const double per_root = 1.0 / std::sqrt(c * cb);
  b.time = y.time + chord * per_root * asinhc(0.5 * g * chord * per_root);
  // c_nn = 0: p keeps, q grows by p·∫c ds
  const double speed_integral = chord * (c * cos_x + tz_ * 0.5 * g * s * ratio);
  b.q = y.q + y.p * speed_integral;
  b.q_plane = y.q_plane + y.p_plane * speed_integral;
  const Row& row = *cell_->row;
  if (row.alpha_slope == 0.0) {
    b.nepers = y.nepers + s * row.alpha_top;
  } else {
    const double half = 0.5 * x, sinc_half = sinc(half), cos_half = cosine(half);
    const double middle = y.depth + 0.5 * s * sinc_half * (tz_ * cos_half + tr_ * half * sinc_half);
    b.nepers =
        y.nepers + s / 6.0 * (row.alpha(y.depth) + 4.0 * row.alpha(middle) + row.alpha(b.depth));
  }
  b.length = y.length + s;
  b.speed_integral = y.speed_integral + speed_integral;
  return b;
}

/// n² = 1/c² = N_a + G(z − z_a). With dw = c·ds: dx/dw = slowness, d(slowness)/dw = ∇n²/2, so the
/// ray is a parabola and a neighbour's distance from it, δx, is linear in w.
RayState Course::end_of_parabola(double w) const noexcept {
  const RayState& y = y_;
  const double c = here_.c, na = 1.0 / (c * c), gradient = bend_;
  RayState b = y;
  b.range = y.range + y.xi * w;
  b.depth = y.depth + w * (y.zeta + 0.25 * gradient * w);
  b.zeta = y.zeta + 0.5 * gradient * w;
  b.time = y.time + w * (na + gradient * w * (0.5 * y.zeta + gradient * w / 12.0));
  const double nb = na + gradient * (b.depth - y.depth);
  const double cb = 1.0 / std::sqrt(nb);
  // s = ∫n dw, ∫α ds: Gauss–Legendre, 4 points
  constexpr std::array node = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                               0.9305681557970263};
  constexpr std::array weight = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                 0.17392742256872692};
  std::array<double, 4> n{}, dz{};
  for (std::size_t i = 0; i < node.size(); ++i) {
    const double v = node[i] * w;
    dz[i] = v * (y.zeta + 0.25 * gradient * v);
    n[i] = weight[i] * std::sqrt(na + gradient * dz[i]);
  }
  const double length = w * ((n[0] + n[1]) + (n[2] + n[3]));
  const Row& row = *cell_->row;
  b.length = y.length + length;
  b.speed_integral = y.speed_integral + w;
  b.nepers = y.nepers + row.alpha(y.depth) * length +
             row.alpha_slope * w * ((n[0] * dz[0] + n[1] * dz[1]) + (n[2] * dz[2] + n[3] * dz[3]));
  // δx₀ = q·n, δ(slowness) = p·n + (c/2)·N_n·q·t; both projected on the end's n and t
  const double er = cb * b.xi, ez = cb * b.zeta;
  const auto carry = [&](double q, double p, double& q_end, double& p_end) {
    const double along = 0.5 * c * gradient * tr_ * q;  // N_n = G·n_z = G·t_r
    const double slow_r = -p * tz_ + along * tr_, slow_z = p * tr_ + along * tz_;
    const double dr = -q * tz_ + slow_r * w, dz_q = q * tr_ + slow_z * w;
    q_end = -dr * ez + dz_q * er;
    const double ahead = dr * er + dz_q * ez;
    p_end = -slow_r * ez + slow_z * er - 0.5 * cb * gradient * er * ahead;
  };
  carry(y.q, y.p, b.q, b.p);
  carry(y.q_plane, y.p_plane, b.q_plane, b.p_plane);
  return b;
}

RayState Course::end_of_series(double time) const noexcept {
  const RayState& y = y_;
  RayState b = y;
  const auto [range, depth, q, q_plane] = series_.values(series_.place, time);
  const auto [tr, tz, growth, growth_plane] = series_.values(series_.motion, time);
  b.range = y.range + range;
  b.depth = y.depth + depth;
  const double c = cell_->speed(b.range, b.depth).c;
  // |slowness| = 1/c, come what may
  const double unit = 1.0 / (c * std::sqrt(tr * tr + tz * tz));
  b.xi = tr * unit;
  b.zeta = tz * unit;
  b.time = y.time + time;
  b.q = q;
  b.p = growth / c;
  b.q_plane = q_plane;
  b.p_plane = growth_plane / c;
  b.length = y.length + series_.value(series_.length, time);
  constexpr double upright = 1e-3;  // cosine
  const bool layered = cell_->law != Law::bilinear && std::abs(tr_) > upright;
  b.speed_integral = y.speed_integral + (layered ? range / y.xi : series_.speed_integral(time));
  b.nepers = y.nepers + series_.value(series_.nepers, time);
  return b;
}

}  // namespace asdic::detail::tracing
