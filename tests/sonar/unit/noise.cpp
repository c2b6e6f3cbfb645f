#include "sonar/noise/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/units.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

constexpr double fs = 16000.0;

TEST(WhiteNoise, LevelsOfThePhysicsPage) {  // 40 dB/Hz: 76.0 dB at 8 kHz, 79.0 at 16 kHz
  EXPECT_NEAR(db_from_power(white_noise_variance(40.0, 8000.0) * 1e12), 76.02, 0.01);
  EXPECT_NEAR(db_from_power(white_noise_variance(40.0, 16000.0) * 1e12), 79.03, 0.01);
}

// Twenty bands of 400 Hz, each with n = 13 100 independent bins: the mean of that many exponentials
// strays 5 sigma = 5/√n = 0.19 dB, so 0.3 dB fails a wrong level and not a fair draw.
TEST(WhiteNoise, SpectrumIsFlatAtTheGivenLevel) {
  const std::size_t n = 1 << 19;
  std::vector<float> pressure(n, 0.0F);
  add_white_noise(pressure, 1, white_noise_variance(40.0, fs), 11, 3);
  FftBuffer<double> x(n);
  std::copy(pressure.begin(), pressure.end(), x.data());
  FftBuffer<std::complex<double>> bins(n / 2 + 1);
  RealFft<double>(n).forward(x.data(), bins.data());
  const std::size_t bands = 20, width = n / 2 / bands;
  for (std::size_t band = 0; band < bands; ++band) {
    double power = 0.0;
    for (std::size_t k = band * width + 1; k <= (band + 1) * width; ++k)
      power += std::norm(bins[k]);
    // One-sided density: 2|X|²/(n·fs) [Pa²/Hz].
    const double density = 2.0 * power / double(width) / (double(n) * fs);
    EXPECT_NEAR(db_from_power(density * 1e12), 40.0, 0.3) << "band " << band;
  }
}

// Correlations of n independent pairs: zero ± 5/√n.
TEST(WhiteNoise, PhonesPingsAndSeedsAreIndependent) {
  const std::size_t n = 100'000;
  const auto record = [&](std::uint64_t seed, std::uint32_t ping) {
    std::vector<float> p(2 * n, 0.0F);
    add_white_noise(p, 2, 1.0, seed, ping);
    return p;
  };
  const auto a = record(1, 1), b = record(1, 2), d = record(2, 1);
  const auto correlation = [&](const float* x, const float* y) {
    return std::inner_product(x, x + n, y, 0.0) / double(n);
  };
  const double limit = 5.0 / std::sqrt(double(n));
  EXPECT_NEAR(correlation(a.data(), a.data()), 1.0, 1.5 * limit);  // the variance: √2 wider
  EXPECT_LT(std::abs(correlation(a.data(), a.data() + n)), limit);
  EXPECT_LT(std::abs(correlation(a.data(), b.data())), limit);
  EXPECT_LT(std::abs(correlation(a.data(), d.data())), limit);
}

TEST(WhiteNoise, APhonesNoiseDoesNotDependOnTheOthers) {
  std::vector<float> two(2 * 5000, 1.0F), three(3 * 5000, 1.0F);
  add_white_noise(two, 2, white_noise_variance(60.0, fs), 5, 0);
  add_white_noise(three, 3, white_noise_variance(60.0, fs), 5, 0);
  EXPECT_TRUE(std::equal(two.begin(), two.end(), three.begin()));
}

}  // namespace
}  // namespace asdic::detail
