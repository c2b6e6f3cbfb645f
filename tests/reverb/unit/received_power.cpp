// Power over bins of delay, and how far what is sent is in phase with itself.
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <numeric>

#include "reverb/power/delay_bins.h"
#include "reverb/power/pulse_coherence.h"

namespace asdic::detail {
namespace {

TEST(DelayBins, AreASixteenthOfThePulse) {
  EXPECT_DOUBLE_EQ(delay_bin(0.8, 60.0), 0.05);
  EXPECT_DOUBLE_EQ(delay_bin(16.0, 60.0), 0.1);     // no wider
  EXPECT_DOUBLE_EQ(delay_bin(0.016, 32.0), 0.002);  // no more than 16 000
}

TEST(DelayBins, SharePowerEvenly) {
  std::array<double, 4> bins{};
  spread(3.0, 0.5, 2.0, std::span<double>(bins));
  EXPECT_DOUBLE_EQ(bins[0], 1.0);
  EXPECT_DOUBLE_EQ(bins[1], 2.0);
  EXPECT_DOUBLE_EQ(bins[2] + bins[3], 0.0);
  spread(5.0, 2.5, 2.5, std::span<double>(bins));  // all at once
  EXPECT_DOUBLE_EQ(bins[2], 5.0);
  spread(7.0, 4.5, 6.0, std::span<double>(bins));  // beyond the last
  EXPECT_DOUBLE_EQ(std::accumulate(bins.begin(), bins.end(), 0.0), 8.0);
}

// R(−Δ) is the conjugate of R(Δ); linear between samples, nothing beyond the duration.
TEST(PulseCoherence, IsItsSamples) {
  const PulseCoherence coherence(0.25, 0.125, {{1.0F, 0.0F}, {0.5F, 0.25F}, {0.0F, 0.0F}});
  EXPECT_EQ(coherence(0.0), 1.0);
  EXPECT_EQ(coherence(0.125), std::complex<double>(0.5, 0.25));
  EXPECT_EQ(coherence(-0.125), std::complex<double>(0.5, -0.25));
  EXPECT_EQ(coherence(0.0625), std::complex<double>(0.75, 0.125));
  EXPECT_EQ(coherence(0.25), 0.0);
  EXPECT_EQ(PulseCoherence()(1e6), 1.0);  // a tone without end
  const PulseCoherence other(0.25, 0.125, {{1.0F, 0.0F}, {0.5F, 0.0F}, {0.0F, 0.0F}});
  EXPECT_NE(coherence.fingerprint(), other.fingerprint());
}

}  // namespace
}  // namespace asdic::detail
