#include "raytrace/tracing/power_series.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <tuple>

namespace asdic::tracing {
namespace {

/// Coefficient k of a product.
double product(const Series& x, const Series& y, std::size_t k) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i <= k; ++i) sum += x[i] * y[k - i];
  return sum;
}

/// The water along the ray as series: c, its gradient, and ∂²c/∂n² made of its second derivatives.
struct Water {
  Series c{}, c_r{}, c_z{}, c_nn{};
};

/// c, c_r, c_z to order k, from the place to order k.
struct CubicWater {
  const Cell& cell;
  SoundSpeed2D s;
  Series square{}, c_zz{}, across{};

  void next(std::size_t k, const PowerSeries& y, Water& w) noexcept {
    const Series& z = y.depth;
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
    across[k] = product(y.tr, y.tr, k);
    w.c_nn[k] = product(c_zz, across, k);
  }
};

struct BilinearWater {
  SoundSpeed2D s;

  void next(std::size_t k, const PowerSeries& y, Water& w) noexcept {
    const Series &r = y.range, &z = y.depth;
    w.c[k] = s.c_r * r[k] + s.c_z * z[k] + s.c_rz * product(r, z, k);
    w.c_r[k] = s.c_rz * z[k];
    w.c_z[k] = s.c_rz * r[k];
    if (k == 0) {
      w.c[0] = s.c;
      w.c_r[0] = s.c_r;
      w.c_z[0] = s.c_z;
    }
    w.c_nn[k] = -2.0 * s.c_rz * product(y.tr, y.tz, k);
  }
};

/// E = e^(−η) follows from Ė = −(2/B)·ż·E.
struct MunkWater {
  const MunkParameters& munk;
  double depth;
  Series decay{}, c_zz{}, across{}, rise{};

  void next(std::size_t k, const PowerSeries& y, Water& w) noexcept {
    const double per_metre = 2.0 / munk.scale_depth;
    const double strength = munk.axis_speed * munk.perturbation;
    const double eta = per_metre * (depth - munk.axis_depth);
    if (k == 0) {
      decay[0] = std::exp(-eta);
    } else {
      rise[k - 1] = static_cast<double>(k) * y.depth[k];  // ż
      decay[k] = -per_metre * product(rise, decay, k - 1) / static_cast<double>(k);
    }
    w.c[k] = strength * (per_metre * y.depth[k] + decay[k]);
    w.c_z[k] = -strength * per_metre * decay[k];
    c_zz[k] = strength * per_metre * per_metre * decay[k];
    if (k == 0) {
      w.c[0] += munk.axis_speed + strength * (eta - 1.0);
      w.c_z[0] += strength * per_metre;
    }
    across[k] = product(y.tr, y.tr, k);
    w.c_nn[k] = product(c_zz, across, k);
  }
};

double largest(std::initializer_list<double> terms) noexcept {
  double most = 0.0;
  for (const double x : terms) most = std::max(most, std::abs(x));
  return most;
}

/// h at which |a|·hⁿ = tolerance.
double within(double a, int n, double tolerance) noexcept {
  return a == 0.0 ? 1e300 : std::pow(tolerance / std::abs(a), 1.0 / n);
}

/// Term k + 1 of everything from the terms up to k, until the last two are small enough where the
/// series is wanted: what is left out is smaller. Flat: the water knows no range.
template <bool flat, class Law>
void expand_in(Law law, const Row& row, double wanted, PowerSeries& y) noexcept {
  constexpr std::size_t most = std::tuple_size_v<Series> - 1;
  Water w;
  Series c_n{}, c_s{};
  const bool lossy = row.alpha_slope != 0.0;
  const double q_weight = 10.0 / (1.0 + std::abs(y.q[0]));
  const double plane_weight = 10.0 / (1.0 + std::abs(y.q_plane[0]));
  double power = 1.0, last = 0.0, before = 0.0;  // the last two terms, weighted, without powers
  for (std::size_t k = 0; k < most; ++k) {
    law.next(k, y, w);
    c_n[k] = product(w.c_z, y.tr, k);
    c_s[k] = product(w.c_z, y.tz, k);
    if constexpr (!flat) {
      c_n[k] -= product(w.c_r, y.tz, k);
      c_s[k] += product(w.c_r, y.tr, k);
    }
    const double share = 1.0 / static_cast<double>(k + 1);
    y.range[k + 1] = share * product(w.c, y.tr, k);
    y.depth[k + 1] = share * product(w.c, y.tz, k);
    y.tr[k + 1] = share * product(c_n, y.tz, k);
    y.tz[k + 1] = -share * product(c_n, y.tr, k);
    y.q[k + 1] = share * product(w.c, y.growth, k);
    y.growth[k + 1] = share * (product(c_s, y.growth, k) - product(w.c_nn, y.q, k));
    y.q_plane[k + 1] = share * product(w.c, y.growth_plane, k);
    y.growth_plane[k + 1] =
        share * (product(c_s, y.growth_plane, k) - product(w.c_nn, y.q_plane, k));
    y.length[k + 1] = share * w.c[k];
    y.nepers[k + 1] = share * (row.alpha_top * w.c[k] +
                               (lossy ? row.alpha_slope * product(w.c, y.depth, k) : 0.0));
    before = last;
    last = largest({y.range[k + 1], y.depth[k + 1], 1e3 * y.tr[k + 1], 1e3 * y.tz[k + 1],
                    q_weight * y.q[k + 1], plane_weight * y.q_plane[k + 1]});
    const double before_it = before * power;
    power *= wanted;
    y.order = k + 1;
    if (k >= 3 && last * power + 0.1 * before_it <= position_tolerance) {
      y.reach = wanted;
      break;
    }
    if (k + 1 == most)
      y.reach = std::min(within(last, most, position_tolerance),
                         within(0.1 * before, most - 1, position_tolerance));
  }
  if (y.order < 6) return;
  // The quintic of a segment leaves out a₆·t³(t − h)³ and more: a₆·h⁶/64 at most.
  const double sixth = largest({y.range[6], y.depth[6], 0.1 * q_weight * y.q[6],
                                0.1 * plane_weight * y.q_plane[6]}) /
                       64.0;
  const double h3 = y.reach * y.reach * y.reach;
  if (sixth * h3 * h3 > quintic_tolerance) y.reach = within(sixth, 6, quintic_tolerance);
}

}  // namespace

void PowerSeries::expand(const Cell& cell, const RayState& y, const Local& here,
                         double wanted) noexcept {
  const SoundSpeed2D s = cell.speed(y.range, y.depth);
  range[0] = depth[0] = length[0] = nepers[0] = 0.0;
  tr[0] = here.c * y.xi;
  tz[0] = here.c * y.zeta;
  q[0] = y.q;
  growth[0] = here.c * y.p;
  q_plane[0] = y.q_plane;
  growth_plane[0] = here.c * y.p_plane;
  Row row = *cell.row;  // α over the depth from here
  row.alpha_top = row.alpha(y.depth);
  if (cell.law == Law::bilinear)
    expand_in<false>(BilinearWater{s}, row, wanted, *this);
  else if (cell.law == Law::munk)
    expand_in<true>(MunkWater{*cell.munk, y.depth}, row, wanted, *this);
  else
    expand_in<true>(CubicWater{cell, s}, row, wanted, *this);
}

}  // namespace asdic::tracing
