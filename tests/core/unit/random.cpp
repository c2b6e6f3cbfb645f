#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/random.h"

namespace asdic::detail {
namespace {

TEST(RandomStream, SameKeySameDraws) {
  RandomStream a(7, Draw::surface_weight, 3, 1234567890123ULL),
      b(7, Draw::surface_weight, 3, 1234567890123ULL);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.normal(), b.normal());
}

TEST(RandomStream, EveryPartOfTheKeyMatters) {
  std::set<double> first;
  for (std::uint64_t seed : {0ULL, 1ULL, 1ULL << 63})
    for (Draw purpose : {Draw::ambient_noise, Draw::surface_weight})
      for (std::uint32_t realisation : {0U, 1U})
        for (std::uint64_t entity : {0ULL, 1ULL, 1ULL << 32})
          first.insert(RandomStream(seed, purpose, realisation, entity).uniform());
  EXPECT_EQ(first.size(), 3U * 2 * 2 * 3);
}

// n draws: the mean of |w|² is 1 ± 1/√n; six standard deviations leave a false alarm of 2e-9.
TEST(RandomStream, ComplexNormalHasUnitMeanSquare) {
  constexpr int n = 200'000;
  RandomStream stream(1, Draw::surface_weight, 0, 0);
  double power = 0.0;
  std::complex<double> mean = 0.0, pseudo = 0.0;
  for (int i = 0; i < n; ++i) {
    const auto w = stream.complex_normal();
    power += std::norm(w) / n;
    mean += w / double(n);
    pseudo += w * w / double(n);
  }
  const double six_sigma = 6.0 / std::sqrt(double(n));
  EXPECT_NEAR(power, 1.0, six_sigma);
  EXPECT_LT(std::abs(mean), six_sigma);
  EXPECT_LT(std::abs(pseudo), 2.0 * six_sigma);  // circular: E w² = 0
}

}  // namespace
}  // namespace asdic::detail
