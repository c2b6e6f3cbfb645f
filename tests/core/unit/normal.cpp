#include "core/normal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "support/kolmogorov.h"

namespace asdic::detail {
namespace {

std::vector<float> normals(std::size_t n, std::uint64_t entity = 0) {
  std::vector<float> values(n);
  fill_normal(values, 42, Draw::ambient_noise, 1, entity);
  return values;
}

// Block j of the stream gives values j mod 16 of batch j/16: Random123's words, by RandomStream,
// through the library's Box–Muller must give the same to a float's rounding.
TEST(FillNormal, IsBoxMullerOfThePhiloxBlocks) {
  const auto values = normals(64 * 40, 0x123456789ULL);
  const RandomStream stream(42, Draw::ambient_noise, 1, 0x123456789ULL);
  for (std::uint32_t block = 0; block < 640; ++block) {
    const auto words = stream.block(block);
    for (std::size_t half = 0; half < 2; ++half) {
      const double radius = std::sqrt(-2.0 * std::log((words[2 * half] / 2 + 0.25) * 0x1p-31));
      const double angle = 2.0 * pi * (words[2 * half + 1] * 0x1p-32);
      const std::size_t at = block / 16 * 64 + half * 32 + block % 16;
      EXPECT_NEAR(double(values[at]), radius * std::cos(angle), 4e-6);
      EXPECT_NEAR(double(values[at + 16]), radius * std::sin(angle), 4e-6);
    }
  }
}

TEST(FillNormal, ShortAndOffsetSpansAreParts) {
  const auto all = normals(1000);
  const auto start = normals(77);
  EXPECT_TRUE(std::equal(start.begin(), start.end(), all.begin()));
  std::vector<float> later(200);
  fill_normal(later, 42, Draw::ambient_noise, 1, 0, 128);
  EXPECT_TRUE(std::equal(later.begin(), later.end(), all.begin() + 128));
}

// Moments of n normals have standard deviations √(1/n), √(2/n), √(15/n), √(96/n); five of them.
TEST(FillNormal, HasTheMomentsOfANormal) {
  const auto values = normals(4'000'000);
  const double n = double(values.size());
  double m1 = 0.0, m2 = 0.0, m3 = 0.0, m4 = 0.0;
  for (double x : values) {
    m1 += x / n;
    m2 += x * x / n;
    m3 += x * x * x / n;
    m4 += x * x * x * x / n;
  }
  EXPECT_NEAR(m1, 0.0, 5.0 * std::sqrt(1.0 / n));
  EXPECT_NEAR(m2, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(m3, 0.0, 5.0 * std::sqrt(15.0 / n));
  EXPECT_NEAR(m4, 3.0, 5.0 * std::sqrt(96.0 / n));
}

/// Kolmogorov's distance from the normal distribution, times √n.
double kolmogorov(const std::vector<float>& values) {
  const auto law = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  return support::kolmogorov_distance(values, law) * std::sqrt(double(values.size()));
}

// P(√n·D > x) = 2 exp(−2x²): 1e-6 at x = 2.69. A normal 1 % too loud must be resolved: it is off
// by 0.01·max x·φ(x) = 2.4e-3, 4.8 at n = 4 million.
TEST(FillNormal, PassesKolmogorovAndAWrongScaleFails) {
  auto values = normals(4'000'000);
  EXPECT_LT(kolmogorov(values), 2.69);
  for (float& x : values) x *= 1.01F;
  EXPECT_GT(kolmogorov(values), 2.69);
}

}  // namespace
}  // namespace asdic::detail
