#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "core/units.h"
#include "sonar/signal/fractional_delay.h"
#include "sonar/signal/interpolation_taps.h"
#include "sonar/signal/tap_sums.h"
#include "sonar/signal/windowed_sinc.h"

namespace asdic::detail {
namespace {

// At a sample the sinc weighs that sample alone; beyond the window it weighs nothing.
TEST(Interpolation, SamplesAreKept) {
  EXPECT_EQ(windowed_sinc(0.0, 16, 10.0), 1.0);
  for (int x = 1; x < 8; ++x) EXPECT_NEAR(windowed_sinc(x, 16, 10.0), 0.0, 1e-16);
  EXPECT_EQ(windowed_sinc(8.5, 16, 10.0), 0.0);
  EXPECT_EQ(windowed_sinc(-3.3, 16, 10.0), windowed_sinc(3.3, 16, 10.0));
}

// The series up to x², whose next term is x⁴/120, meets the quotient.
TEST(Interpolation, SineOverItsAngleHasNoStep) {
  const double x = 1e-4;
  EXPECT_NEAR(sine_over(std::nextafter(x, 0.0)), sine_over(std::nextafter(x, 1.0)), 3e-16);
  EXPECT_NEAR(sine_over(0.5 * pi), 2.0 / pi, 1e-16);
}

TEST(Interpolation, PolynomialsAreTheWindowedSinc) {
  constexpr double beta = 11.8;
  using Taps = InterpolationTaps<double, 16>;
  const Taps taps(beta);
  for (const double fraction : {0.0, 0.1, 0.37, 0.5, 0.93}) {
    const Taps::Weights weights = taps.at(fraction);
    for (int tap = 0; tap < Taps::taps; ++tap)
      EXPECT_NEAR(weights[tap], windowed_sinc(fraction - (tap - Taps::before), 16, beta), 1e-9)
          << tap << " at " << fraction;
  }
}

/// Σ w_k·x_k, tap after tap.
template <std::size_t taps>
float plain_sum(const std::array<float, taps>& weights, const float* samples, std::size_t apart) {
  float sum = 0.0F;
  for (std::size_t k = 0; k < taps; ++k) sum += weights[k] * samples[k * apart];
  return sum;
}

/// Numbers within ±1 that repeat nowhere.
template <class Numbers>
void fill_uneven(Numbers& numbers, double step) {
  double x = 0.1;
  for (auto& number : numbers) {
    x += step;
    number =
        static_cast<std::remove_reference_t<decltype(number)>>(2.0 * (x - std::floor(x)) - 1.0);
  }
}

// Numbers side by side, in lanes or as parts of a complex number, do not touch each other.
TEST(TapSums, GatherIsThePlainSumOfEachChannel) {
  constexpr std::size_t taps = 12, channels = 8;
  using Lanes [[gnu::vector_size(4 * sizeof(float))]] = float;
  std::array<float, taps> weights;
  std::array<float, taps * channels> samples;
  fill_uneven(weights, 0.618034);
  fill_uneven(samples, 0.414214);
  const auto weight = [&](std::size_t k) { return weights[k]; };
  const auto numbers = gather<float, taps, channels>(
      weight, [&](std::size_t k, std::size_t j) { return samples[k * channels + j]; });
  const auto in_lanes = gather<Lanes, taps, 2>(weight, [&](std::size_t k, std::size_t j) {
    const float* x = &samples[k * channels + 4 * j];
    return Lanes{x[0], x[1], x[2], x[3]};
  });
  for (std::size_t j = 0; j < channels; ++j) {
    const float expected = plain_sum(weights, &samples[j], channels);
    EXPECT_FLOAT_EQ(numbers[j], expected);
    EXPECT_FLOAT_EQ(in_lanes[j / 4][j % 4], expected);
  }
}

TEST(TapSums, TapsInLanesAreThePlainSum) {
  using Weights = InterpolationTaps<double, 16>::Weights;
  Weights weights;
  std::array<double, 24> samples;
  fill_uneven(weights, 0.618034);
  fill_uneven(samples, 0.414214);
  for (std::size_t from = 0; from < 8; ++from) {  // wherever they lie in memory
    double expected = 0.0;
    for (std::size_t k = 0; k < 16; ++k)
      expected += weights[static_cast<Eigen::Index>(k)] * samples[from + k];
    EXPECT_NEAR(gather(weights, &samples[from]), expected, 1e-15);
  }
}

// ⟨gather x, y⟩ = ⟨x, deposit y⟩: what an impulse leaves on a grid, read there, is what the grid
// weighs at the impulse.
TEST(TapSums, DepositIsTheAdjointOfGather) {
  constexpr std::size_t grids = 4, impulses = 5, row = 6, stride = 21;
  using Weights = Eigen::Array<float, 16, 1, Eigen::DontAlign>;
  std::array<Weights, impulses> taps;
  for (std::size_t r = 0; r < impulses; ++r)
    fill_uneven(taps[r], 0.618034 + 0.01 * static_cast<double>(r));
  std::array<float, impulses * row> shares;
  std::array<float, grids * stride> grid, there;
  fill_uneven(shares, 0.732051);
  fill_uneven(there, 0.414214);
  fill_uneven(grid, 0.236068);
  const auto before = grid;
  deposit<grids>(taps.data(), impulses, shares.data(), row, grid.data(), stride);
  double laid = 0.0, read = 0.0;
  for (std::size_t i = 0; i < grid.size(); ++i)
    laid += (double{grid[i]} - double{before[i]}) * double{there[i]};
  for (std::size_t r = 0; r < impulses; ++r)
    for (std::size_t j = 0; j < grids; ++j)
      read += double{shares[r * row + j] * gather(taps[r], &there[j * stride])};
  EXPECT_NEAR(laid, read, 1e-5);
  EXPECT_GT(std::abs(read), 0.1);
  for (std::size_t j = 0; j < grids; ++j)  // and nothing beside the taps
    for (std::size_t k = 16; k < stride; ++k)
      EXPECT_EQ(grid[j * stride + k], before[j * stride + k]);
}

// The header's −90 dB, of a tone a quarter of the sample rate away from zero at the most.
TEST(Interpolation, ToneBetweenSamplesIsThatTone) {
  constexpr int samples = 64;
  constexpr std::int64_t first = -20;
  for (const double frequency : {-0.25, -0.1, 0.03, 0.2, 0.25}) {
    const auto tone = [&](double place) { return std::polar(1.0, 2.0 * pi * frequency * place); };
    std::vector<float> interleaved;
    for (int i = 0; i < samples; ++i) {
      const std::complex<double> x = tone(static_cast<double>(first + i));
      interleaved.push_back(static_cast<float>(x.real()));
      interleaved.push_back(static_cast<float>(x.imag()));
    }
    for (double place = -10.0; place < 30.0; place += 0.173) {
      const std::complex<float> got =
          FractionalDelay::shared().at(interleaved.data(), first, place);
      EXPECT_LT(std::abs(std::complex<double>(got) - tone(place)), std::pow(10.0, -90.0 / 20.0))
          << frequency << " at " << place;
    }
  }
}

// Float has no number between 1 − 3e-8 and 1. The table ends there: what lies behind it is not to
// be read, for 0 times that need not be 0 (ships' noise had single samples that were no number).
TEST(Interpolation, PlaceJustBelowASampleIsThatSample) {
  std::vector<float> samples(64, 0.0F);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>(i);
  for (const double below : {1e-12, 1e-9, 1e-8}) {
    const std::complex<float> got = FractionalDelay::shared().at(samples.data(), 0, 16.0 - below);
    EXPECT_NEAR(got.real(), 32.0F, 1e-5F) << below;
    EXPECT_NEAR(got.imag(), 33.0F, 1e-5F) << below;
  }
}

}  // namespace
}  // namespace asdic::detail
