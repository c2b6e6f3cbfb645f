#pragma once
#include <cmath>

namespace asdic::detail {

/// Airy's functions and their derivatives at one place, real or complex.
template <class Number>
struct Airy {
  Number ai, ai_slope, bi, bi_slope;
};

/// By the power series: 1e-8 of the greatest for −10 ≤ x ≤ 6. DLMF 9.4
template <class Number>
[[nodiscard]] Airy<Number> airy(Number x) noexcept {
  constexpr double ai_0 = 0.355028053887817239, ai_slope_0 = -0.258819403792806798;
  const Number cube = x * x * x;
  // f = 1 + x³/3! + …, g = x + 2x⁴/4! + …, and their derivatives
  Number f = 1.0, g = x, df = 0.5 * x * x, dg = 1.0;
  Number f_sum = f, g_sum = g, df_sum = df, dg_sum = dg;
  for (int k = 1; k < 60; ++k) {
    const double n = 3.0 * k;
    f *= cube / ((n - 1.0) * n);
    g *= cube / (n * (n + 1.0));
    df *= cube / (n * (n + 2.0));
    dg *= cube / ((n - 2.0) * n);
    f_sum += f, g_sum += g, df_sum += df, dg_sum += dg;
  }
  const double root = std::sqrt(3.0);
  return {.ai = ai_0 * f_sum + ai_slope_0 * g_sum,
          .ai_slope = ai_0 * df_sum + ai_slope_0 * dg_sum,
          .bi = root * (ai_0 * f_sum - ai_slope_0 * g_sum),
          .bi_slope = root * (ai_0 * df_sum - ai_slope_0 * dg_sum)};
}

}  // namespace asdic::detail
