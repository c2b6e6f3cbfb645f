#include "raytrace/tracing/cell.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace asdic::tracing {
namespace {

/// ∂²c/∂n² with n = (−t_z, t_r).
double across(const SoundSpeed2D& s, double tr, double tz) noexcept {
  return s.c_rr * tz * tz - 2.0 * s.c_rz * tr * tz + s.c_zz * tr * tr;
}

double sinc(double x) noexcept { return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }

double asinc(double x) noexcept {
  return std::abs(x) < 1e-4 ? 1.0 + x * x / 6.0 : std::asin(x) / x;
}

double asinhc(double x) noexcept {
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::asinh(x) / x;
}

/// c = c_a + g(z − z_a): the direction turns evenly, φ(s) = φ_a − gξ·s, so the chord has the mean
/// direction and the length s·sin(x)/x, x = −gξs/2.
RayState along_arc(const Cell& cell, const RayState& y, double s) noexcept {
  const SoundSpeed2D a = cell.speed(y.range, y.depth);
  const double g = a.c_z;
  const double x = -0.5 * g * y.xi * s;
  const double cos_x = std::cos(x), sin_x = std::sin(x);
  const double tr = a.c * y.xi, tz = a.c * y.zeta;
  const double chord = s * sinc(x);
  const double mean_r = tr * cos_x - tz * sin_x, mean_z = tz * cos_x + tr * sin_x;
  RayState b = y;
  b.range = y.range + chord * mean_r;
  b.depth = y.depth + chord * mean_z;
  const double cb = a.c + g * (b.depth - y.depth);
  // direction at the end: turned by 2x; ξ is Snell's invariant
  const double end_z = tz * (cos_x * cos_x - sin_x * sin_x) + 2.0 * tr * sin_x * cos_x;
  b.zeta = end_z / cb;
  // τ = (2/g)·asinh(g·d/(2√(c_a c_b))), d the chord
  const double root = std::sqrt(a.c * cb);
  b.time = y.time + chord / root * asinhc(0.5 * g * chord / root);
  // c_nn = 0: p keeps, q grows by p·∫c ds, and ∫c ds = Δr/ξ
  const double speed_integral = chord * (a.c * cos_x + tz * 0.5 * g * s * sinc(x));
  b.q = y.q + y.p * speed_integral;
  b.q_plane = y.q_plane + y.p_plane * speed_integral;
  const double middle =
      y.depth + 0.5 * s * sinc(0.5 * x) * (tz * std::cos(0.5 * x) + tr * std::sin(0.5 * x));
  b.nepers = y.nepers + s / 6.0 *
                            (cell.row->alpha(y.depth) + 4.0 * cell.row->alpha(middle) +
                             cell.row->alpha(b.depth));  // Simpson
  b.length = y.length + s;
  return b;
}

/// n² = 1/c² = N_a + G(z − z_a). With dw = c·ds: dx/dw = slowness, d(slowness)/dw = ∇n²/2, so the
/// ray is a parabola and a neighbour's distance from it, δx, is linear in w.
RayState along_parabola(const Cell& cell, const RayState& y, double w) noexcept {
  const SoundSpeed2D a = cell.speed(y.range, y.depth);
  const double na = 1.0 / (a.c * a.c);
  const double gradient = -2.0 * a.c_z * na / a.c;  // G = d(c⁻²)/dz = −2 c_z/c³
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
  double length = 0.0, nepers = 0.0;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const double v = node[i] * w;
    const double dz = v * (y.zeta + 0.25 * gradient * v);
    const double n = std::sqrt(na + gradient * dz);
    length += weight[i] * n;
    nepers += weight[i] * n * cell.row->alpha(y.depth + dz);
  }
  b.length = y.length + w * length;
  b.nepers = y.nepers + w * nepers;
  // δx₀ = q·n, δ(slowness) = p·n + (c/2)·N_n·q·t; both projected on the end's n and t
  const double tr = a.c * y.xi, tz = a.c * y.zeta, er = cb * b.xi, ez = cb * b.zeta;
  const auto carry = [&](double q, double p, double& q_end, double& p_end) {
    const double along = 0.5 * a.c * gradient * tr * q;  // N_n = G·n_z = G·t_r
    const double slow_r = -p * tz + along * tr, slow_z = p * tr + along * tz;
    const double dr = -q * tz + slow_r * w, dz = q * tr + slow_z * w;
    q_end = -dr * ez + dz * er;
    const double ahead = dr * er + dz * ez;
    p_end = -slow_r * ez + slow_z * er - 0.5 * cb * gradient * er * ahead;
  };
  carry(y.q, y.p, b.q, b.p);
  carry(y.q_plane, y.p_plane, b.q_plane, b.p_plane);
  return b;
}

using Vector = std::array<double, 10>;  // r, z, ξ, ζ, τ, q, p, q_plane, p_plane, nepers

/// d(state)/ds; Porter & Bucker, JASA 82, 1349 (1987).
Vector derivative(const Cell& cell, const Vector& y) noexcept {
  const SoundSpeed2D s = cell.speed(y[0], y[1]);
  const double slow = 1.0 / (s.c * s.c);
  const double tr = s.c * y[2], tz = s.c * y[3];
  const double bend = -across(s, tr, tz) * slow;
  return {tr,
          tz,  // dx/ds = c·ξ
          -s.c_r * slow,
          -s.c_z * slow,  // dξ/ds = −∇c/c²
          1.0 / s.c,      // dτ/ds = 1/c
          s.c * y[6],
          bend * y[5],  // dq/ds = c·p, dp/ds = −(c_nn/c²)·q
          s.c * y[8],
          bend * y[7],
          cell.row->alpha(y[1])};
}

/// One step of Dormand & Prince's 5(4) pair, J. Comp. Appl. Math. 6, 19 (1980).
RayState step_general(const Cell& cell, const RayState& from, double h, double* error) noexcept {
  const Vector y = {0.0,    from.depth, from.xi,      from.zeta,    0.0,
                    from.q, from.p,     from.q_plane, from.p_plane, 0.0};
  const auto f = [&](Vector v) {
    v[0] += from.range;
    return derivative(cell, v);
  };
  const auto sum = [&](std::initializer_list<std::pair<double, const Vector*>> terms) {
    Vector v = y;
    for (const auto& [a, k] : terms)
      for (std::size_t i = 0; i < v.size(); ++i) v[i] += h * a * (*k)[i];
    return v;
  };
  const Vector k1 = f(y);
  const Vector k2 = f(sum({{1.0 / 5.0, &k1}}));
  const Vector k3 = f(sum({{3.0 / 40.0, &k1}, {9.0 / 40.0, &k2}}));
  const Vector k4 = f(sum({{44.0 / 45.0, &k1}, {-56.0 / 15.0, &k2}, {32.0 / 9.0, &k3}}));
  const Vector k5 = f(sum({{19372.0 / 6561.0, &k1},
                           {-25360.0 / 2187.0, &k2},
                           {64448.0 / 6561.0, &k3},
                           {-212.0 / 729.0, &k4}}));
  const Vector k6 = f(sum({{9017.0 / 3168.0, &k1},
                           {-355.0 / 33.0, &k2},
                           {46732.0 / 5247.0, &k3},
                           {49.0 / 176.0, &k4},
                           {-5103.0 / 18656.0, &k5}}));
  const Vector end = sum({{35.0 / 384.0, &k1},
                          {500.0 / 1113.0, &k3},
                          {125.0 / 192.0, &k4},
                          {-2187.0 / 6784.0, &k5},
                          {11.0 / 84.0, &k6}});
  if (error != nullptr) {
    const Vector k7 = f(end);
    constexpr std::array e = {71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
                              -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};
    const double slow = std::abs(y[2]) + std::abs(y[3]);
    const Vector tolerance = {position_tolerance,
                              position_tolerance,
                              1e-11 * slow,
                              1e-11 * slow,
                              1e-3 * position_tolerance,
                              1e-9 * (1.0 + std::abs(end[5])),
                              1e-9 * (slow + std::abs(end[6])),
                              1e-9 * (1.0 + std::abs(end[7])),
                              1e-9 * (slow * 1e-3 + std::abs(end[8])),
                              1e-9};
    double worst = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double off = h * (e[0] * k1[i] + e[2] * k3[i] + e[3] * k4[i] + e[4] * k5[i] +
                              e[5] * k6[i] + e[6] * k7[i]);
      worst = std::max(worst, std::abs(off) / tolerance[i]);
    }
    *error = worst;
  }
  RayState to = from;
  to.range += end[0];
  to.depth = end[1];
  to.xi = end[2];
  to.zeta = end[3];
  to.time += end[4];
  to.q = end[5];
  to.p = end[6];
  to.q_plane = end[7];
  to.p_plane = end[8];
  to.nepers += end[9];
  to.length += h;
  return to;
}

}  // namespace

SoundSpeed2D Cell::speed(double range, double depth) const noexcept {
  if (ocean->section)
    return ocean->section->at(range, depth, {.column = column, .row = row->interval});
  const SoundSpeedProfile& water = ocean->water;
  const SoundSpeed s = water.munk_parameters() ? water.at(depth) : water.at(depth, row->interval);
  return {.c = s.c, .c_z = s.dc_dz, .c_zz = s.d2c_dz2};
}

Local local(const Cell& cell, const RayState& y) noexcept {
  const SoundSpeed2D s = cell.speed(y.range, y.depth);
  return {s.c, s.c_r, s.c_z, across(s, s.c * y.xi, s.c * y.zeta)};
}

RayState advance(const Cell& cell, const RayState& y, double h, double* error) noexcept {
  switch (cell.law) {
    case Law::arc:
      return along_arc(cell, y, h);
    case Law::parabola:
      return along_parabola(cell, y, h);
    case Law::general:
      break;
  }
  return step_general(cell, y, h, error);
}

double step_to_depth(const Cell& cell, const RayState& y, double depth) noexcept {
  const SoundSpeed2D a = cell.speed(y.range, y.depth);
  const double dz = depth - y.depth;
  if (cell.law == Law::parabola) {
    const double gradient = -2.0 * a.c_z / (a.c * a.c * a.c);
    const double square = y.zeta * y.zeta + gradient * dz;  // ζ_b²
    if (square < 0.0) return never;
    const double end = std::copysign(std::sqrt(square), dz);
    if (y.zeta * dz < 0.0 || y.zeta + end == 0.0) return never;
    return 2.0 * dz / (y.zeta + end);
  }
  const double tz = a.c * y.zeta;
  if (cell.law == Law::arc) {
    const double cb = a.c + a.c_z * dz;
    // sin²φ_b = 1 − ξ²c_b², without cancellation: sin²φ_a + ξ²(c_a² − c_b²)
    const double square = tz * tz - y.xi * y.xi * a.c_z * dz * (a.c + cb);
    if (square < 0.0) return never;
    const double end = std::copysign(std::sqrt(square), dz);
    if (tz * dz < 0.0 || tz + end == 0.0) return never;
    const double dr = y.xi * (a.c + cb) * dz / (tz + end);  // Δr = ξ(c_a + c_b)Δz/(s_a + s_b)
    const double chord = std::hypot(dr, dz);
    return chord * asinc(std::min(1.0, 0.5 * std::abs(a.c_z * y.xi) * chord));
  }
  // z(s) ≈ z + t_z s + z'' s²/2, z'' = −(c_n/c) t_r
  const double tr = a.c * y.xi;
  const double half_bend = -0.5 * (-a.c_r * tz + a.c_z * tr) / a.c * tr;
  const double square = tz * tz + 4.0 * half_bend * dz;
  if (square < 0.0) return never;
  const double end = std::copysign(std::sqrt(square), dz);
  if (tz * dz < 0.0 || tz + end == 0.0) return never;
  return 2.0 * dz / (tz + end);
}

double step_to_turn(const Cell& cell, const RayState& y) noexcept {
  const SoundSpeed2D a = cell.speed(y.range, y.depth);
  if (y.zeta == 0.0) return never;
  if (cell.law == Law::parabola) {
    const double gradient = -2.0 * a.c_z / (a.c * a.c * a.c);
    return y.zeta * gradient < 0.0 ? -2.0 * y.zeta / gradient : never;
  }
  const double rate = -a.c_z / (a.c * a.c);  // dζ/ds
  if (!(y.zeta * rate < 0.0)) return never;
  if (cell.law == Law::arc) {
    // φ = 0 (or π): φ_a − gξs = 0 with φ_a the angle from the horizontal in the direction of travel
    const double phi = std::atan2(y.zeta, std::abs(y.xi));
    return phi / (a.c_z * std::abs(y.xi));
  }
  return -y.zeta / rate;
}

}  // namespace asdic::tracing
