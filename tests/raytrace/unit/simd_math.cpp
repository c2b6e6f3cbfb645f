#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/math/simd_math.h"

namespace asdic::detail {
namespace {

/// The largest difference from the library's function over [from, to], relative to max(|f|,
/// 1e-300).
template <class Of, class Expected>
double worst(double from, double to, const Of& of, const Expected& expected) {
  double error = 0.0;
  for (int i = 0; i <= 20'000; ++i) {
    const double x = from + (to - from) * i / 20'000;
    const double want = expected(x);
    error = std::max(error, std::abs(of(Rays(x))[0] - want) / std::max(std::abs(want), 1e-300));
  }
  return error;
}

// A handful of roundings of 1.1e-16 each; e^x besides has x's own, 600 × 1.1e-16 × 2⁻⁵² of it less
// the reduction, which is exact to 1e-26·n.
TEST(LaneMath, ExponentialIsTheLibrarys) {
  EXPECT_LT(worst(-20.0, 20.0, exponential, [](double x) { return std::exp(x); }), 1e-15);
  EXPECT_LT(worst(-600.0, 600.0, exponential, [](double x) { return std::exp(x); }), 1e-15);
}

TEST(LaneMath, LogarithmIsTheLibrarys) {
  EXPECT_LT(worst(1e-3, 0.7, logarithm, [](double x) { return std::log(x); }), 1e-15);
  EXPECT_LT(worst(1.5, 1e6, logarithm, [](double x) { return std::log(x); }), 1e-15);
  // Near 1 the last step of n·ln 2 + ln m is exact, and s is right to a rounding.
  EXPECT_LT(worst(
                0.75, 1.35, [](const Rays& x) { return Rays(logarithm(x) - (x - 1.0)); },
                [](double x) { return std::log1p(x - 1.0) - (x - 1.0); }),
            1e-9);  // of a difference that vanishes at 1
}

// Beyond the series: (1 + x)/(1 − x) is right to two roundings, 2e-16 of 1, and its logarithm at
// least 0.12.
TEST(LaneMath, AtanhAndAsinAreTheLibrarys) {
  const auto atanh = [](double x) { return x == 0.0 ? 1.0 : std::atanh(x) / x; };
  const auto asin = [](double x) { return x == 0.0 ? 1.0 : std::asin(x) / x; };
  EXPECT_LT(worst(-0.999, 0.999, atanh_over, atanh), 5e-15);
  EXPECT_LT(worst(-1.0, 1.0, asin_over, asin), 1e-15);
}

// Lanes of different size take different ways; none disturbs another.
TEST(LaneMath, LanesAreIndependent) {
  const Rays x([](auto i) { return i % 2 == 0 ? 0.01 : 0.7; });
  const Rays ratio = atanh_over(x), angle = asin_over(x);
  for (std::size_t i = 0; i < rays_at_once; ++i) {
    EXPECT_NEAR(ratio[i], std::atanh(x[i]) / x[i], 5e-15);
    EXPECT_NEAR(angle[i], std::asin(x[i]) / x[i], 5e-15);
  }
}

}  // namespace
}  // namespace asdic::detail
