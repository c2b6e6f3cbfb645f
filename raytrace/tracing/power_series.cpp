#include "raytrace/tracing/power_series.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace asdic::tracing {
namespace {

using Terms = std::array<double, Series::order + 1>;

/// Coefficient k of a product.
double product(const Terms& x, const Terms& y, std::size_t k) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i <= k; ++i) sum += x[i] * y[k - i];
  return sum;
}

/// The water along the ray as series: c, its gradient, and ∂²c/∂n² made of its second derivatives.
struct Water {
  Terms c{}, c_r{}, c_z{}, c_nn{};
};

/// c, c_r, c_z to order k, from the place to order k.
struct CubicWater {
  const Cell& cell;
  SoundSpeed2D s;
  Terms square{}, c_zz{}, across{};

  void next(std::size_t k, const PowerSeries& y, Water& w) noexcept {
    const Terms& z = y.depth.a;
    const double a3 = cell.a[3];
    square[k] = product(z, z, k);
    w.c[k] = s.c_z * z[k] + 0.5 * s.c_zz * square[k] + a3 * product(z, square, k);
    w.c_z[k] = s.c_zz * z[k] + 3.0 * a3 * square[k];
    c_zz[k] = 6.0 * a3 * z[k];
    if (k == 0) {
      w.c[0] = s.c;
      w.c_z[0] = s.c_z;
      c_zz[0] = s.c_zz;
    }
    across[k] = product(y.tr.a, y.tr.a, k);
    w.c_nn[k] = product(c_zz, across, k);
  }
};

struct BilinearWater {
  SoundSpeed2D s;

  void next(std::size_t k, const PowerSeries& y, Water& w) noexcept {
    const Terms &r = y.range.a, &z = y.depth.a;
    w.c[k] = s.c_r * r[k] + s.c_z * z[k] + s.c_rz * product(r, z, k);
    w.c_r[k] = s.c_rz * z[k];
    w.c_z[k] = s.c_rz * r[k];
    if (k == 0) {
      w.c[0] = s.c;
      w.c_r[0] = s.c_r;
      w.c_z[0] = s.c_z;
    }
    w.c_nn[k] = -2.0 * s.c_rz * product(y.tr.a, y.tz.a, k);
  }
};

/// E = e^(−η) follows from Ė = −(2/B)·ż·E.
struct MunkWater {
  const MunkParameters& munk;
  double depth;
  Terms decay{}, c_zz{}, across{}, rise{};

  void next(std::size_t k, const PowerSeries& y, Water& w) noexcept {
    const double per_metre = 2.0 / munk.scale_depth;
    const double strength = munk.axis_speed * munk.perturbation;
    const double eta = per_metre * (depth - munk.axis_depth);
    if (k == 0) {
      decay[0] = std::exp(-eta);
    } else {
      rise[k - 1] = static_cast<double>(k) * y.depth.a[k];  // ż
      decay[k] = -per_metre * product(rise, decay, k - 1) / static_cast<double>(k);
    }
    w.c[k] = strength * (per_metre * y.depth.a[k] + decay[k]);
    w.c_z[k] = -strength * per_metre * decay[k];
    c_zz[k] = strength * per_metre * per_metre * decay[k];
    if (k == 0) {
      w.c[0] += munk.axis_speed + strength * (eta - 1.0);
      w.c_z[0] += strength * per_metre;
    }
    across[k] = product(y.tr.a, y.tr.a, k);
    w.c_nn[k] = product(c_zz, across, k);
  }
};

/// Term k + 1 of everything from the terms up to k. Flat: the water knows no range.
template <bool flat, class Law>
void expand_in(Law law, const Row& row, PowerSeries& y) noexcept {
  Water w;
  Terms c_n{}, c_s{};
  const bool lossy = row.alpha_slope != 0.0;
  for (std::size_t k = 0; k < Series::order; ++k) {
    law.next(k, y, w);
    c_n[k] = product(w.c_z, y.tr.a, k);
    c_s[k] = product(w.c_z, y.tz.a, k);
    if constexpr (!flat) {
      c_n[k] -= product(w.c_r, y.tz.a, k);
      c_s[k] += product(w.c_r, y.tr.a, k);
    }
    const double share = 1.0 / static_cast<double>(k + 1);
    y.range.a[k + 1] = share * product(w.c, y.tr.a, k);
    y.depth.a[k + 1] = share * product(w.c, y.tz.a, k);
    y.tr.a[k + 1] = share * product(c_n, y.tz.a, k);
    y.tz.a[k + 1] = -share * product(c_n, y.tr.a, k);
    y.q.a[k + 1] = share * product(w.c, y.growth.a, k);
    y.growth.a[k + 1] = share * (product(c_s, y.growth.a, k) - product(w.c_nn, y.q.a, k));
    y.q_plane.a[k + 1] = share * product(w.c, y.growth_plane.a, k);
    y.growth_plane.a[k + 1] =
        share * (product(c_s, y.growth_plane.a, k) - product(w.c_nn, y.q_plane.a, k));
    y.length.a[k + 1] = share * w.c[k];
    y.nepers.a[k + 1] = share * (row.alpha_top * w.c[k] +
                                 (lossy ? row.alpha_slope * product(w.c, y.depth.a, k) : 0.0));
  }
}

/// h at which |a|·hⁿ = tolerance.
double within(double a, int n, double tolerance) noexcept {
  return a == 0.0 ? 1e300 : std::pow(tolerance / std::abs(a), 1.0 / n);
}

}  // namespace

void PowerSeries::expand(const Cell& cell, const RayState& y, const Local& here) noexcept {
  const Row& row = *cell.row;
  const SoundSpeed2D s = cell.speed(y.range, y.depth);
  range.a[0] = depth.a[0] = length.a[0] = nepers.a[0] = 0.0;
  tr.a[0] = here.c * y.xi;
  tz.a[0] = here.c * y.zeta;
  q.a[0] = y.q;
  growth.a[0] = here.c * y.p;
  q_plane.a[0] = y.q_plane;
  growth_plane.a[0] = here.c * y.p_plane;
  Row from_here = row;  // α over depth from here
  from_here.alpha_top = row.alpha(y.depth);
  if (cell.law == Law::bilinear)
    expand_in<false>(BilinearWater{s}, from_here, *this);
  else if (cell.law == Law::munk)
    expand_in<true>(MunkWater{*cell.munk, y.depth}, from_here, *this);
  else
    expand_in<true>(CubicWater{cell, s}, from_here, *this);
  // The last term stands for what is left out, which is smaller. The quintic of a segment leaves
  // out a_6·t³(t − h)³ and more: a_6·h⁶/64 at most.
  constexpr int n = Series::order;
  const auto largest = [](std::initializer_list<double> terms) {
    double most = 0.0;
    for (const double x : terms) most = std::max(most, std::abs(x));
    return most;
  };
  const double q_size = 1.0 + std::abs(y.q), plane_size = 1.0 + std::abs(y.q_plane);
  const double last = largest({range.a[n], depth.a[n], 1e3 * tr.a[n], 1e3 * tz.a[n],
                               10.0 * q.a[n] / q_size, 10.0 * q_plane.a[n] / plane_size});
  const double before =
      0.1 * largest({range.a[n - 1], depth.a[n - 1], 1e3 * tr.a[n - 1], 1e3 * tz.a[n - 1],
                     10.0 * q.a[n - 1] / q_size, 10.0 * q_plane.a[n - 1] / plane_size});
  const double sixth =
      largest({range.a[6], depth.a[6], q.a[6] / q_size, q_plane.a[6] / plane_size}) / 64.0;
  reach = std::min({within(last, n, position_tolerance), within(before, n - 1, position_tolerance),
                    within(sixth, 6, quintic_tolerance)});
}

}  // namespace asdic::tracing
