#include "raytrace/tracing/power_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace asdic::detail::tracing {
namespace {

using Terms = std::vector<double>;

double product(const Terms& x, const Terms& y, std::size_t k) {
  double sum = 0.0;
  for (std::size_t i = 0; i <= k; ++i) sum += x[i] * y[k - i];
  return sum;
}

/// The same series one by one, term by term as the equations are written: the plain version.
struct PlainSeries {
  explicit PlainSeries(std::size_t terms)
      : r(terms), z(terms), tr(terms), tz(terms), q(terms), growth(terms), length(terms) {}
  Terms r, z, tr, tz, q, growth, length;
};

PlainSeries plain(const Cell& cell, const RayState& y, std::size_t order) {
  PlainSeries s(order + 1);
  const SoundSpeed2D w = cell.speed(y.range, y.depth);
  s.tr[0] = w.c * y.xi;
  s.tz[0] = w.c * y.zeta;
  s.q[0] = y.q;
  s.growth[0] = w.c * y.p;
  const std::size_t n = order + 1;
  Terms c(n), c_r(n), c_z(n), c_zz(n), c_rz(n), c_n(n), c_s(n), c_nn(n), square(n), rr(n), rz(n),
      zz(n);
  const double a3 = cell.law == Law::cubic ? cell.a[3] : 0.0;
  for (std::size_t k = 0; k < order; ++k) {
    const auto first = [&](double value) { return k == 0 ? value : 0.0; };
    square[k] = product(s.z, s.z, k);
    c[k] = first(w.c) + w.c_r * s.r[k] + w.c_z * s.z[k] + w.c_rz * product(s.r, s.z, k) +
           0.5 * w.c_zz * square[k] + a3 * product(s.z, square, k);
    c_r[k] = first(w.c_r) + w.c_rz * s.z[k];
    c_z[k] = first(w.c_z) + w.c_rz * s.r[k] + w.c_zz * s.z[k] + 3.0 * a3 * square[k];
    c_zz[k] = first(w.c_zz) + 6.0 * a3 * s.z[k];
    c_rz[k] = first(w.c_rz);
    c_n[k] = product(c_z, s.tr, k) - product(c_r, s.tz, k);
    c_s[k] = product(c_z, s.tz, k) + product(c_r, s.tr, k);
    zz[k] = product(s.tr, s.tr, k);
    rz[k] = product(s.tr, s.tz, k);
    c_nn[k] = product(c_zz, zz, k) - 2.0 * product(c_rz, rz, k);
    const double share = 1.0 / static_cast<double>(k + 1);
    s.r[k + 1] = share * product(c, s.tr, k);
    s.z[k + 1] = share * product(c, s.tz, k);
    s.tr[k + 1] = share * product(c_n, s.tz, k);
    s.tz[k + 1] = -share * product(c_n, s.tr, k);
    s.q[k + 1] = share * product(c, s.growth, k);
    s.growth[k + 1] = share * (product(c_s, s.growth, k) - product(c_nn, s.q, k));
    s.length[k + 1] = share * c[k];
  }
  return s;
}

// Sums of the same products in another order: some roundings of each, of what a term is worth at
// the end of the series.
TEST(PowerSeries, FourAtOnceAreThePlainOnes) {
  const Row row{.top = 0.0, .bottom = 500.0};
  Cell cubic{.row = &row, .law = Law::cubic, .z0 = 50.0};
  cubic.a = {1500.0, -0.08, 2e-4, -3e-7};
  Cell bilinear{.row = &row, .law = Law::bilinear, .r0 = 100.0, .z0 = 50.0};
  bilinear.a = {1500.0, -0.05, 0.0, 0.0};
  bilinear.b = {2e-3, -1e-5};
  for (const Cell& cell : {cubic, bilinear})
    for (const double angle : {-1.2, -0.3, -0.01, 0.0, 0.02, 0.4, 1.5}) {
      RayState y{.range = 180.0, .depth = 120.0};
      const Local here = local(cell, y);
      y.xi = std::cos(angle) / here.c;
      y.zeta = std::sin(angle) / here.c;
      y.q = 3000.0;
      y.p = -2e-3;
      y.q_plane = -7.0;
      y.p_plane = 1e-4;
      PowerSeries series;
      const double wanted = 0.5;
      series.expand(cell, y, here, wanted);
      ASSERT_GE(series.order, 4U);
      RayState plane = y;
      plane.q = y.q_plane;
      plane.p = y.p_plane;
      const PlainSeries s = plain(cell, y, series.order), t = plain(cell, plane, series.order);
      double power = 1.0;
      for (std::size_t k = 0; k <= series.order; ++k, power *= wanted) {
        const auto near = [&](double value, double reference, double scale) {
          EXPECT_NEAR(value * power, reference * power, 1e-14 * scale) << k << " at " << angle;
        };
        const auto &place = series.place[k], &motion = series.motion[k];
        near(place[PowerSeries::range], s.r[k], 1e3);
        near(place[PowerSeries::depth], s.z[k], 1e3);
        near(motion[PowerSeries::tr], s.tr[k], 1.0);
        near(motion[PowerSeries::tz], s.tz[k], 1.0);
        near(place[PowerSeries::q], s.q[k], 1e4);
        near(motion[PowerSeries::growth], s.growth[k], 1e2);
        near(place[PowerSeries::q_plane], t.q[k], 1e2);
        near(motion[PowerSeries::growth_plane], t.growth[k], 1.0);
        near(series.length[k], s.length[k], 1e3);
      }
      const auto place = series.values(series.place, 0.3);
      const auto [r, z] = series.where(0.3);
      EXPECT_NEAR(place[PowerSeries::range], r.value, 1e-11);
      EXPECT_NEAR(place[PowerSeries::depth], z.value, 1e-11);
      const auto depth = series.value_and_slope(series.place, PowerSeries::depth, 0.3);
      EXPECT_NEAR(depth.value, z.value, 1e-11);
      EXPECT_NEAR(depth.slope, z.slope, 1e-10);
    }
}

}  // namespace
}  // namespace asdic::detail::tracing
