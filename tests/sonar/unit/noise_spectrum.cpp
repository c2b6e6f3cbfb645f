#include "sonar/noise/noise_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>

namespace asdic::detail {
namespace {

// Coates' sums done by hand at 1 kHz, where every lg f is 0: turbulence 17, shipping ½ 40 −
// 60 lg 1.03 = 39.23, wind 10 m/s 50 + 23.72 − 40 lg 1.4 = 67.87 dB; their powers add up to 67.88.
TEST(WenzNoise, ByHandAtOneKilohertz) {
  const WenzNoise usual{.shipping = 0.5, .wind_speed = 10.0},
      calm{.shipping = 0.0, .wind_speed = 0.0};
  EXPECT_NEAR(usual.level_at(1000.0), 67.877, 0.01);
  // Calm, no ships: turbulence 17, shipping 29.23, wind 50 − 5.85 = 44.15.
  EXPECT_NEAR(calm.level_at(1000.0), 44.302, 0.01);
}

// Which of the parts is received where: Wenz (1962), fig. 13. Turbulence falls 30 dB a decade below
// 10 Hz, ships fill 20–200 Hz, wind 0.5–50 kHz at −20 dB a decade, molecules rise 20 dB a decade.
TEST(WenzNoise, IsTurbulenceThenShipsThenWindThenMolecules) {
  const WenzNoise heavy{.shipping = 1.0, .wind_speed = 5.0},
      light{.shipping = 0.0, .wind_speed = 5.0};
  EXPECT_NEAR(light.level_at(1.0) - light.level_at(2.0), 30.0 * std::log10(2.0), 0.1);
  EXPECT_GT(heavy.level_at(60.0) - light.level_at(60.0), 15.0);
  EXPECT_LT(heavy.level_at(5000.0) - light.level_at(5000.0), 0.1);
  EXPECT_NEAR(light.level_at(1e4) - light.level_at(1e5), 20.0, 0.7);
  NoiseSettings noise{.law = light, .thermal = true, .directions = {}};
  EXPECT_NEAR(noise_level_db(noise, 1e6) - noise_level_db(noise, 5e5), 6.02, 0.05);
  EXPECT_NEAR(noise_level_db(noise, 1e6), 45.0, 0.05);  // −15 + 60
}

TEST(KnudsenNoise, OfThePhysicsPage) {  // N(1 kHz) − 17 lg f: 44 … 70 dB
  const double at_1_khz[] = {44.0, 55.0, 61.5, 64.5, 66.5, 68.5, 70.0};
  for (int sea = 0; sea <= 6; ++sea) {
    EXPECT_NEAR(KnudsenNoise{double(sea)}.level_at(1000.0), at_1_khz[sea], 1e-9);
    EXPECT_NEAR(KnudsenNoise{double(sea)}.level_at(10000.0), at_1_khz[sea] - 17.0, 1e-9);
  }
  // "40 dB/Hz at 4 kHz is about sea state 0.5": 49.5 − 10.2 = 39.3.
  EXPECT_NEAR(KnudsenNoise{0.5}.level_at(4000.0), 40.0, 1.0);
  EXPECT_NEAR(KnudsenNoise::sea_state_of_wind(0.0), 0.0, 1e-12);
  EXPECT_NEAR(KnudsenNoise::sea_state_of_wind(13.5 * 1852.0 / 3600.0), 3.0, 1e-12);
  EXPECT_NEAR(KnudsenNoise::sea_state_of_wind(40.0), 6.0, 1e-12);
}

TEST(NoiseTable, IsStraightOverLogFrequencyAndConstantBeyond) {
  const NoiseTable table{.frequency = {100.0, 1000.0}, .level_db = {80.0, 60.0}};
  EXPECT_NEAR(table.level_at(100.0 * std::sqrt(10.0)), 70.0, 1e-9);
  EXPECT_EQ(table.level_at(1.0), 80.0);
  EXPECT_EQ(table.level_at(5000.0), 60.0);
}

TEST(NoisePower, IsTheIntegralOfTheDensity) {
  NoiseSettings noise;
  EXPECT_EQ(noise_band_db(noise, 1000.0, 100.0), -infinity);
  noise.law = WhiteNoise{40.0};
  EXPECT_NEAR(noise_band_db(noise, 4000.0, 100.0), 60.0, 1e-12);
  noise = {.law = KnudsenNoise{3.0}, .directions = {}};
  // ∫ 10^6.45 f^−1.7 df = 10^6.45 (f₁^−0.7 − f₂^−0.7)/0.7, f in kHz; times 1000 Hz.
  const double exact =
      64.5 + 10.0 * std::log10(1000.0 / 0.7 * (std::pow(0.5, -0.7) - std::pow(6.5, -0.7)));
  EXPECT_NEAR(noise_band_db(noise, 3500.0, 6000.0), exact, 1e-3);
  // A white table is white.
  noise.law = NoiseTable{.frequency = {10.0}, .level_db = {40.0}};
  EXPECT_NEAR(noise_power(noise, 0.0, 8000.0) * 1e12, 1e4 * 8000.0, 1.0);
}

}  // namespace
}  // namespace asdic::detail
