#include "raytrace/tracing/row_crossing.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace asdic::detail::tracing {
namespace {

using State = std::array<double, 7>;  // r, τ, s, ∫α ds, q, p, unused

/// The equations of docs/theory/rays.md over depth instead of arc length, by the classical
/// Runge–Kutta method: slow, and of no use near a turning point.
State integrate(const Cell& cell, const RayState& y, double to) {
  constexpr int steps = 4000;
  const double h = (to - y.depth) / steps, xi = y.xi, down = y.zeta > 0.0 ? 1.0 : -1.0;
  const auto rate = [&](double z, const State& x) {
    const SoundSpeed2D s = cell.speed(0.0, z);
    const double cosine = xi * s.c, sine = down * std::sqrt(1.0 - cosine * cosine);
    const double c_nn = s.c_zz * cosine * cosine;
    return State{cosine / sine,
                 1.0 / (s.c * sine),
                 1.0 / sine,
                 cell.row->alpha(z) / sine,
                 s.c * x[5] / sine,
                 -c_nn / (s.c * s.c) * x[4] / sine,
                 0.0};
  };
  const auto moved = [](const State& x, const State& d, double by) {
    State out;
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = x[i] + by * d[i];
    return out;
  };
  State x = {0.0, 0.0, 0.0, 0.0, y.q, y.p, 0.0};
  for (int i = 0; i < steps; ++i) {
    const double z = y.depth + i * h;
    const State k1 = rate(z, x), k2 = rate(z + 0.5 * h, moved(x, k1, 0.5 * h));
    const State k3 = rate(z + 0.5 * h, moved(x, k2, 0.5 * h)), k4 = rate(z + h, moved(x, k3, h));
    for (std::size_t j = 0; j < x.size(); ++j)
      x[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
  }
  return x;
}

// Rows of 20 to 220 m under every law, up and down, to greater and smaller ranges. Four thousand
// steps of a fourth-order method leave some 1e-12 of what they sum up, and the rounding of as many
// steps as much.
TEST(RowCrossing, IsWhatTheEquationsIntegrateTo) {
  std::mt19937_64 draw(7);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(draw);
  };
  int crossed = 0;
  for (int i = 0; i < 400; ++i) {
    Row row{.top = 100.0, .bottom = 100.0 + uniform(20.0, 220.0)};
    row.alpha_top = 1e-5;
    row.alpha_slope = i % 2 == 0 ? 3e-8 : 0.0;
    Cell cell{.row = &row, .z0 = 100.0};
    const double gradient = uniform(-0.1, 0.1);
    if (i % 3 == 0) {
      cell.a = {1500.0, gradient, 0.0, 0.0};
    } else if (i % 3 == 1) {
      cell.law = Law::parabola;
      cell.a = {1.0 / (1500.0 * 1500.0), -2.0 * gradient / (1500.0 * 1500.0 * 1500.0), 0.0, 0.0};
    } else {
      cell.law = Law::cubic;
      cell.a = {1500.0, gradient, uniform(-1e-4, 1e-4), uniform(-3e-7, 3e-7)};
    }
    const double angle = uniform(0.1, 1.4), down = i % 4 < 2 ? 1.0 : -1.0,
                 forward = i % 5 == 0 ? -1.0 : 1.0;
    RayState y{.range = 10.0, .depth = uniform(row.top + 1.0, row.bottom - 1.0)};
    const double c = cell.speed(0.0, y.depth).c;
    y.xi = forward * std::cos(angle) / c;
    y.zeta = down * std::sin(angle) / c;
    y.q = uniform(-1e4, 1e4);
    y.p = uniform(-1e-2, 1e-2);
    const double to = down > 0.0 ? row.bottom : row.top;
    RowCrossing x;
    if (!cross_row(cell, y, local(cell, y), to, x)) continue;
    ++crossed;
    const State exact = integrate(cell, y, to);
    double q = 0.0, p = 0.0;
    const double tz_end = down * x.sine;
    carry_tube(y.q, y.p, y.xi, c * y.zeta, local(cell, y).c_z, x, tz_end, q, p);
    EXPECT_NEAR(x.range, exact[0], 1e-10 * x.length);
    EXPECT_NEAR(x.time, exact[1], 1e-11 * x.time);
    EXPECT_NEAR(x.length, exact[2], 1e-11 * x.length);
    EXPECT_NEAR(q, exact[4], 1e-9 * (std::abs(y.q) + std::abs(y.p) * c * x.length));
    EXPECT_NEAR(p, exact[5], 1e-9 * (std::abs(y.p) + 1e-3));
    // along an arc Simpson's rule: s⁵·d⁴z/ds⁴/2880, d⁴z/ds⁴ the third power of the bend at most, a
    // turn of 0.1 rad: 3.5e-7·s²·dα/dz at most, of α·s
    const double nepers = row.alpha(y.depth) * x.length + row.alpha_slope * x.depth_integral;
    EXPECT_NEAR(nepers, exact[3],
                3.5e-7 * row.alpha_slope * x.length * x.length + 1e-11 * exact[3]);
    EXPECT_NEAR(x.sine, std::sqrt(1.0 - std::pow(y.xi * x.c, 2)), 1e-12);
    EXPECT_NEAR(x.c, cell.speed(0.0, to).c, 1e-9);
    EXPECT_NEAR(x.c_z, cell.speed(0.0, to).c_z, 1e-12);
  }
  EXPECT_GT(crossed, 200);
}

// A ray that turns before the line, or grazes it, is left to the steps.
TEST(RowCrossing, IsNotForRaysThatTurn) {
  const Row row{.top = 0.0, .bottom = 400.0};
  for (const Law law : {Law::arc, Law::parabola, Law::cubic}) {
    Cell cell{.row = &row, .law = law};
    cell.a = {1500.0, 0.1, law == Law::cubic ? 1e-5 : 0.0, 0.0};
    if (law == Law::parabola)
      cell.a = {1.0 / (1500.0 * 1500.0), -2.0 * 0.1 / (1500.0 * 1500.0 * 1500.0), 0.0, 0.0};
    RayState y{.depth = 10.0};
    const double c = cell.speed(0.0, y.depth).c;
    y.xi = std::cos(0.1) / c;
    y.zeta = std::sin(0.1) / c;
    RowCrossing x;
    EXPECT_FALSE(cross_row(cell, y, local(cell, y), row.bottom, x));
  }
}

}  // namespace
}  // namespace asdic::detail::tracing
