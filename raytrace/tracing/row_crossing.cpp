#include "raytrace/tracing/row_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/math/gauss_legendre.h"

namespace asdic::detail::tracing {
namespace {

/// Shallower rays, and those that turn by more, take a step: tubes are carried with divisions by
/// the sine, series below stop early.
constexpr double least_sine = 0.05, widest_bend = 0.1;

/// asin(√y)/√y, and with a negative y asinh(√−y)/√−y, for |y| ≤ 0.0025: the next term is 4e-18.
double asinc_of_square(double y) noexcept {
  return 1.0 + y * (1.0 / 6.0 + y * (3.0 / 40.0 + y * (5.0 / 112.0 +
                                                       y * (35.0 / 1152.0 + y * (63.0 / 2816.0)))));
}

/// Sines and cosines at both ends: cos = ξ·c, and sin₁² = sin₀² − (cos₁ − cos₀)(cos₁ + cos₀)
/// without cancellation. The chord is across |Δz|, along |Δz|·(cos₀ + cos₁)/(sin₀ + sin₁).
bool cross_arc(const Cell& cell, const RayState& y, const Local& here, double to,
               RowCrossing& x) noexcept {
  const double dz = to - y.depth, way = std::abs(dz), g = cell.a[1], c0 = here.c;
  const double c1 = c0 + g * dz;
  const double sin0 = std::abs(c0 * y.zeta), cos0 = c0 * y.xi, cos1 = c1 * y.xi;
  const double square = sin0 * sin0 - y.xi * g * dz * (cos0 + cos1);
  if (!(square > least_sine * least_sine)) return false;
  const double sin1 = std::sqrt(square);
  x.turn = std::abs(sin0 * cos1 - sin1 * cos0);
  const double per_sines = 1.0 / (sin0 + sin1);
  x.speed_integral = way * (c0 + c1) * per_sines;
  x.range = y.xi * x.speed_integral;
  const double chord = std::sqrt(dz * dz + x.range * x.range);
  const double half_sine = 0.5 * g * y.xi * chord;  // of half the turn
  const double per_c = 1.0 / (c0 * c1), piece = 0.25 * g * g * chord * chord * per_c;
  if (x.turn > widest_bend || piece > 0.0025) return false;
  const double bent = half_sine * half_sine;
  x.length = chord * asinc_of_square(bent);
  x.time = chord * std::sqrt(per_c) * asinc_of_square(-piece);
  if (cell.row->alpha_slope != 0.0) {  // Simpson's rule: z is a sine of the length
    const double middle =
        0.5 * dz + 0.5 * x.range * half_sine / (1.0 + std::sqrt(1.0 - bent));  // chord and sagitta
    x.depth_integral = x.length / 6.0 * (4.0 * middle + dz);
  }
  x.spread = x.speed_integral / (sin0 * sin1);
  x.sine = sin1;
  x.c = c1;
  x.c_z = g;
  x.c_zz = 0.0;
  return true;
}

/// 1/c² = N + G(z − z₀), dw = c·ds: ζ₁² = ζ₀² + GΔz and w = 2|Δz|/(ζ₀ + ζ₁).
bool cross_parabola(const Cell& cell, const RayState& y, double to, RowCrossing& x) noexcept {
  const double dz = to - y.depth, gradient = cell.a[1];
  const double na = cell.a[0] + gradient * (y.depth - cell.z0), nb = na + gradient * dz;
  const double zeta0 = std::abs(y.zeta), square = y.zeta * y.zeta + gradient * dz;
  if (!(square > least_sine * least_sine * nb)) return false;
  const double zeta1 = std::sqrt(square);
  x.c = 1.0 / std::sqrt(nb);
  x.turn = std::abs(y.xi * (zeta1 - zeta0)) * x.c * x.c;  // about its sine: n changes by little
  if (x.turn > 0.9 * widest_bend) return false;
  const double w = 2.0 * std::abs(dz) / (zeta0 + zeta1);
  x.speed_integral = w;
  x.range = y.xi * w;
  x.time = w * (na + gradient * w * (0.5 * y.zeta + gradient * w / 12.0));
  using Rule = GaussLegendre<4>;
  double length = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {  // s = ∫n dw
    const double v = (0.5 + 0.5 * Rule::node[i]) * w;
    const double down = v * (y.zeta + 0.25 * gradient * v);
    const double n = 0.5 * Rule::weight[i] * std::sqrt(na + gradient * down);
    length += n;
    moment += n * down;
  }
  x.length = w * length;
  x.depth_integral = w * moment;
  x.spread = w * (1.0 + y.xi * y.xi / (zeta0 * zeta1));
  x.sine = zeta1 * x.c;
  x.c_z = -0.5 * x.c * x.c * x.c * gradient;
  x.c_zz = 3.0 * x.c_z * x.c_z / x.c;
  return true;
}

/// |r| = ∫ξc/s dz, τ = ∫1/(cs) dz, length ∫1/s dz, ∂r/∂ξ = ∫c/s³ dz, s² = 1 − ξ²c².
template <std::size_t n>
void integrate(const SoundSpeed2D& m, double a3, double half, double xi, RowCrossing& x) noexcept {
  using Rule = GaussLegendre<n>;
  std::array<double, n> range{}, time{}, length{}, spread{}, moment{};
  for (std::size_t i = 0; i < n; ++i) {
    const double u = half * Rule::node[i];  // from the middle, signed
    const double c = m.c + u * (m.c_z + u * (0.5 * m.c_zz + u * a3));
    const double square = 1.0 - xi * xi * c * c;
    const double per_sine = 1.0 / std::sqrt(square);
    const double weight = Rule::weight[i] * per_sine;
    length[i] = weight;
    range[i] = weight * c;
    time[i] = weight / c;
    spread[i] = weight * c * per_sine * per_sine;
    moment[i] = weight * (u + half);
  }
  double r = 0.0, t = 0.0, l = 0.0, s = 0.0, z = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    r += range[i];
    t += time[i];
    l += length[i];
    s += spread[i];
    z += moment[i];
  }
  const double way = std::abs(half);
  x.speed_integral = way * r;
  x.range = way * xi * r;
  x.time = way * t;
  x.length = way * l;
  x.spread = way * s;
  x.depth_integral = way * z;
}

/// c a cubic. With u in halves of the way from its middle, s² = s_m² − ξ²(c² − c_m²) has no zero as
/// long as 2ξ²c_m·(d₁|u| + d₂|u|² + d₃|u|³) < s_m², d the terms of c: so the integrands are
/// analytic within |u| < R, and n nodes leave some (R + √(R² − 1))^(−2n): 2e-13, 4e-14, 3e-14
/// below.
bool cross_cubic(const Cell& cell, const RayState& y, double to, RowCrossing& x) noexcept {
  const double half = 0.5 * (to - y.depth), size = std::abs(half);
  const SoundSpeed2D m = cell.speed(y.range, y.depth + half);
  const double a3 = cell.a[3];
  const double d1 = std::abs(m.c_z) * size, d2 = 0.5 * std::abs(m.c_zz) * size * size,
               d3 = std::abs(a3) * size * size * size;
  const double xi2 = y.xi * y.xi, sine2 = 1.0 - xi2 * m.c * m.c;
  const double room = sine2 / (2.0 * xi2 * m.c);
  const auto clear = [&](double r) { return r * (d1 + r * (d2 + r * d3)) < room; };
  const bool four = clear(20.0);
  if (!four && !clear(2.5)) return false;
  const double end_c = m.c + half * (m.c_z + half * (0.5 * m.c_zz + half * a3));
  const double square = 1.0 - xi2 * end_c * end_c;
  if (!(square > least_sine * least_sine)) return false;
  if (four)
    integrate<4>(m, a3, half, y.xi, x);
  else if (clear(3.5))
    integrate<8>(m, a3, half, y.xi, x);
  else
    integrate<10>(m, a3, half, y.xi, x);
  // dφ/ds = −ξ·c_z
  x.turn = std::abs(y.xi) * (d1 + 2.0 * d2 + 3.0 * d3) / size * x.length;
  // what the quintic between the ends leaves out, as for a power series: of the order of
  // turn³·length·1/46 000
  if (x.turn > widest_bend || x.turn * x.turn * x.turn * x.length > 0.2) return false;
  x.sine = std::sqrt(square);
  x.c = end_c;
  x.c_z = m.c_z + half * (m.c_zz + half * 3.0 * a3);
  x.c_zz = m.c_zz + 6.0 * a3 * half;
  return true;
}

}  // namespace

bool cross_row(const Cell& cell, const RayState& y, const Local& here, double to,
               RowCrossing& out) noexcept {
  switch (cell.law) {
    case Law::arc:
      return cross_arc(cell, y, here, to, out);
    case Law::parabola:
      return cross_parabola(cell, y, to, out);
    case Law::cubic:
      return cross_cubic(cell, y, to, out);
    case Law::bilinear:
    case Law::munk:
      break;
  }
  return false;
}

}  // namespace asdic::detail::tracing
