#include "sonar/signal/power_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/random.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr double rate = 4000.0;  // [Hz]

std::vector<float> noise(std::size_t samples, double deviation, std::uint32_t which = 0) {
  RandomStream stream(5, Draw::ambient_noise, which, 0);
  std::vector<float> made(samples);
  for (float& x : made) x = static_cast<float>(deviation * stream.normal());
  return made;
}

std::vector<std::complex<float>> complex_noise(std::size_t samples, double deviation) {
  const std::vector<float> re = noise(samples, deviation, 1), im = noise(samples, deviation, 2);
  std::vector<std::complex<float>> made;
  for (std::size_t i = 0; i < samples; ++i) made.emplace_back(re[i], im[i]);
  return made;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Σ S Δf is the mean over segments of Σ w² x²/Σ w², of any samples (Parseval), here by loops over
// times alone. Rounding: 1e-12.
TEST(PowerSpectrum, HoldsParseval) {
  const std::size_t length = 60;
  const std::vector<float> x = noise(317, 2.0);
  const std::vector<std::complex<float>> z = complex_noise(317, 3.0);
  double of_x = 0.0, of_z = 0.0, weight = 0.0;
  int segments = 0;
  for (std::size_t first = 0; first + length <= x.size(); first += length / 2, ++segments)
    for (std::size_t i = 0; i < length; ++i) {
      const double w = std::pow(std::sin(pi * double(i) / double(length)), 4);
      of_x += w * std::pow(double(x[first + i]), 2);
      of_z += w * std::norm(std::complex<double>(z[first + i])) / 2.0;
      weight += w;
    }
  const PowerSpectrum real = power_spectrum(x, rate, length),
                      complex = power_spectrum(z, rate, 1000.0, length);
  EXPECT_EQ(segments, 9);
  EXPECT_EQ(real.segments, segments);
  EXPECT_EQ(complex.segments, segments);
  EXPECT_EQ(real.density.size(), 31U);
  EXPECT_EQ(complex.density.size(), 60U);
  EXPECT_NEAR(sum(real.density) * real.frequency_step * weight / of_x, 1.0, 1e-12);
  EXPECT_NEAR(sum(complex.density) * complex.frequency_step * weight / of_z, 1.0, 1e-12);
}

// A tone of amplitude a at one of the frequencies: a²/3 there and a²/12 in either neighbour, a²/2
// together; nothing else but rounding of the samples to float.
TEST(PowerSpectrum, ToneHasItsPower) {
  const double a = 0.7;
  const std::size_t length = 400;
  std::vector<float> x;
  for (int i = 0; i < 4000; ++i)
    x.push_back(static_cast<float>(a * std::cos(2.0 * pi * 250.0 * i / rate + 0.3)));
  const auto expect_tone = [&](const PowerSpectrum& found, double frequency) {
    EXPECT_DOUBLE_EQ(found.frequency_step, 10.0);
    const auto k = static_cast<std::size_t>(
        std::lround((frequency - found.first_frequency) / found.frequency_step));
    ASSERT_LT(k + 1, found.density.size());
    EXPECT_NEAR(found.density[k] * 10.0, a * a / 3.0, 1e-6);
    EXPECT_NEAR(found.density[k - 1] * 10.0, a * a / 12.0, 1e-6);
    EXPECT_NEAR(found.density[k + 1] * 10.0, a * a / 12.0, 1e-6);
    EXPECT_NEAR(sum(found.density) * 10.0, a * a / 2.0, 1e-6);
  };
  expect_tone(power_spectrum(x, rate, length), 250.0);
  for (const double offset : {-620.0, 370.0}) {  // of the envelope's tone from the carrier
    std::vector<std::complex<float>> z;
    for (int i = 0; i < 4000; ++i)
      z.emplace_back(std::polar(a, 2.0 * pi * offset * i / rate + 0.3));
    const PowerSpectrum found = power_spectrum(z, rate, 5000.0, length);
    EXPECT_DOUBLE_EQ(found.first_frequency, 3000.0);
    expect_tone(found, 5000.0 + offset);
  }
}

// White noise of variance σ² is even, σ²/(r/2) one-sided; of an envelope of variance σ² in either
// part p has variance σ² in a band r. The mean of N samples' squares scatters by √(2/N), of the
// Hann windows' little more. A bin of K segments, each correlated with the next by 1/6 (Hann, half
// over), scatters by √((1 + 2·(1 − 1/K)/36)/K) (Welch, 1967), known to √(2/bins)/2 from as many
// bins.
TEST(PowerSpectrum, WhiteNoiseIsEven) {
  const double deviation = 1.7;
  const std::size_t samples = 1 << 18, length = 512;
  const auto expect_even = [&](const PowerSpectrum& found, std::size_t first, std::size_t last,
                               double density) {
    const double n = static_cast<double>(last - first), k = found.segments;
    double mean = 0.0, square = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      mean += found.density[i] / density / n;
      square += std::pow(found.density[i] / density, 2) / n;
    }
    EXPECT_NEAR(mean, 1.0, 6.0 * std::sqrt(2.0 / static_cast<double>(samples)));
    const double scatter = std::sqrt(square - mean * mean),
                 expected = std::sqrt((1.0 + 2.0 * (1.0 - 1.0 / k) / 36.0) / k);
    EXPECT_NEAR(scatter / expected, 1.0, 6.0 * std::sqrt(2.0 / n) / 2.0 * 1.5);
  };
  const PowerSpectrum real = power_spectrum(noise(samples, deviation), rate, length);
  expect_even(real, 2, length / 2 - 1, deviation * deviation / (rate / 2.0));
  const PowerSpectrum complex =
      power_spectrum(complex_noise(samples, deviation), rate, 1000.0, length);
  expect_even(complex, 0, length, deviation * deviation / rate);
}

TEST(PowerSpectrum, SegmentsAreAtLeastAsLongAsAskedFor) {
  EXPECT_EQ(segment_length(4000.0, 1.0), 4000U);
  EXPECT_EQ(segment_length(4000.0, 2000.0), 2U);
  EXPECT_EQ(segment_length(4000.0, 1e9), 2U);
  for (const double step : {0.31, 3.7, 41.0}) {
    const std::size_t length = segment_length(4001.0, step);
    EXPECT_EQ(length % 2, 0U);
    EXPECT_LE(4001.0 / double(length), step);
    EXPECT_LT(double(length), 1.25 * 4001.0 / step);
  }
}

}  // namespace
}  // namespace asdic::detail
