#include "reverb/scattering/sea_draws.h"

#include <gtest/gtest.h>

#include <cmath>

namespace asdic::detail {
namespace {

// Sums kept equal those drawn, whatever the order and the count that were asked for before.
TEST(SeaDraws, KeptSumsAreThoseDrawn) {
  SeaDraws draws(3);
  for (const int count : {5, 7, 5, 1, 7})
    for (int part = 0; part < 3; ++part)
      for (std::size_t bounce = 0; bounce < 3; ++bounce) {
        const SeaDraws::Try at{.path = 77, .part = part, .bounce = bounce, .number = 2};
        const WaveSum kept = draws.sum(at, count), drawn = SeaDraws(3).drawn_sum(at, count);
        EXPECT_EQ(kept.along, drawn.along);
        EXPECT_EQ(kept.across, drawn.across);
        EXPECT_EQ(kept.omega, drawn.omega);
      }
}

// One more wave is added to the same ones: P(K > x) of a wave is 1 − exp(−1/x²), and none is
// below 0.2 in a million draws or so (e^−25).
TEST(SeaDraws, AddsWavesToTheSameOnes) {
  const SeaDraws draws(1);
  const SeaDraws::Try at{.path = 5, .part = 1, .bounce = 4};
  WaveSum before;
  for (int count = 1; count < 50; ++count) {
    const WaveSum now = draws.drawn_sum(at, count);
    const double wave = std::hypot(double(now.along - before.along),
                                   double(now.across - before.across)),
                 omega = double(now.omega - before.omega);
    EXPECT_GT(wave, 0.2);
    EXPECT_NEAR(omega * omega, wave, 1e-3 * (1.0 + wave));  // ω² = gK
    before = now;
  }
}

// The median of one wave's K is 1/√(ln 2), and half of the waves go either way.
TEST(SeaDraws, HaveTheSpectrumOfTheSea) {
  const SeaDraws isotropic(9), crested(9, Sea::long_crested);
  int below = 0, ahead = 0, right = 0, towards = 0, aside = 0;
  constexpr int n = 4000;
  for (int part = 0; part < n; ++part) {
    const SeaDraws::Try at{.path = 1, .part = part};
    const WaveSum wave = isotropic.drawn_sum(at, 1);
    below += std::hypot(double(wave.along), double(wave.across)) < 1.0 / std::sqrt(std::log(2.0));
    ahead += wave.along > 0.0F;
    right += wave.across > 0.0F;
    towards += wave.omega > 0.0F;
    aside += crested.drawn_sum(at, 1).across != 0.0F;
  }
  const double four_sigma = 4.0 * std::sqrt(0.25 * n);
  for (const int count : {below, ahead, right, towards}) EXPECT_NEAR(count, 0.5 * n, four_sigma);
  EXPECT_EQ(aside, 0);
}

}  // namespace
}  // namespace asdic::detail
