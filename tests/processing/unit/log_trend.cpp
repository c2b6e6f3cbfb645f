#include "processing/log_trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/random.h"
#include "processing/normaliser.h"

namespace asdic::detail {
namespace {

std::vector<double> two_sided(int guard, int cells) {
  std::vector<double> times;
  for (int k = guard + 1; k <= guard + cells; ++k) times.insert(times.end(), {-1.0 * k, 1.0 * k});
  return times;
}

// The integral as it stands, by Simpson's rule over every b at which it is not nothing.
TEST(LogTrend, IsTheIntegral) {
  const std::vector<double> powers{0.3, 2.0, 0.9, 1.4}, times{-3.0, -1.0, 2.0, 7.0};
  for (const double x : {0.01, 1.0, 30.0, 1e4}) {
    double top = 0.0, bottom = 0.0;
    constexpr int n = 40000;
    for (int i = 0; i <= n; ++i) {
      const double b = -10.0 + 20.0 * i / n, weight = i == 0 || i == n ? 1.0
                                                      : i % 2 == 1     ? 4.0
                                                                       : 2.0;
      double s = 0.0;
      for (int j = 0; j < 4; ++j) s += powers[j] * std::exp(-b * times[j]);
      top += weight * std::exp(-b * 5.0) * std::pow(s + x, -4.0);
      bottom += weight * std::exp(-b * 5.0) * std::pow(s, -4.0);
    }
    EXPECT_NEAR(log_exceedance_over_trend(powers, times, x), std::log(top / bottom), 1e-8) << x;
  }
}

// Uniform whatever the slope and wherever the cells: of 20 000 draws the share below P is binomial,
// 4.9 standard deviations are 10⁻⁶. The mean of the same cells (Finn & Johnson) is not: over 24
// cells that rise by 1 dB each, half of them after the test, its rate is far off.
TEST(LogTrend, KeepsTheRateOnEverySlope) {
  std::vector<double> one_sided, gaps{-40.0, -39.0, -20.0, -5.0, -4.0, 6.0, 30.0};
  for (int k = 3; k < 15; ++k) one_sided.push_back(-k);
  struct Case {
    std::vector<double> times;
    double db = 0.0;  // a cell
  };
  for (const Case& now : {Case{two_sided(2, 12), 0.0}, Case{two_sided(2, 12), 1.0},
                          Case{one_sided, -2.5}, Case{gaps, 0.7}}) {
    RandomStream random(11, Draw::study_noise, 0, now.times.size());
    constexpr int n = 20000;
    double below_tenth = 0.0, below_hundredth = 0.0, by_mean = 0.0;
    for (int i = 0; i < n; ++i) {
      std::vector<double> powers;
      double mean = 0.0;
      for (const double t : now.times) {
        powers.push_back(std::norm(random.complex_normal()) * std::pow(10.0, 0.1 * now.db * t));
        mean += powers.back() / static_cast<double>(now.times.size());
      }
      const double x = std::norm(random.complex_normal());
      const double p = std::exp(log_exceedance_over_trend(powers, now.times, x));
      below_tenth += p < 0.1;
      below_hundredth += p < 0.01;
      by_mean += x > mean * cfar_multiplier(0.01, static_cast<double>(now.times.size()));
    }
    EXPECT_NEAR(below_tenth / n, 0.1, 4.9 * std::sqrt(0.09 / n)) << now.db;
    EXPECT_NEAR(below_hundredth / n, 0.01, 4.9 * std::sqrt(0.0099 / n)) << now.db;
    if (now.db != 0.0) {
      EXPECT_GT(std::abs(by_mean / n - 0.01), 4.9 * std::sqrt(0.0099 / n)) << now.db;
    }
  }
}

// Between cells on both sides a trend costs next to nothing where there is none: that its slope is
// not known takes less than one in 24 of ln P.
TEST(LogTrend, IsTheMeanBetweenEvenCells) {
  const std::vector<double> powers(24, 2.0), times = two_sided(2, 12);
  for (const double x : {1.0, 10.0, 25.0}) {
    const double mean = -24.0 * std::log1p(x / 48.0);
    EXPECT_NEAR(log_exceedance_over_trend(powers, times, x), mean, std::abs(mean) / 24.0) << x;
  }
}

}  // namespace
}  // namespace asdic::detail
