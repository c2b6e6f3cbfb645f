#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/units.h"
#include "sonar/signal/fractional_delay.h"
#include "sonar/signal/interpolation_taps.h"
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
