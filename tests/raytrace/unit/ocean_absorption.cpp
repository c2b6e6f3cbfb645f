#include <gtest/gtest.h>

#include "raytrace/ocean/absorption.h"

namespace asdic::detail {
namespace {

TEST(Absorption, NoneIsNone) { EXPECT_EQ(absorption_db_per_km(NoAbsorption{}, 4000.0), 0.0); }

// The two cubics of the pure-water term meet at 20 °C as well as their three printed digits allow:
// 2.201e-4 against 2.200e-4 dB/(km·kHz²), and at 1 MHz that term is all there is.
TEST(Absorption, FrancoisGarrisonIsContinuousAtTwentyDegrees) {
  const double below = absorption_db_per_km(FrancoisGarrison{.temperature = 20.0}, 1e6);
  const double above = absorption_db_per_km(FrancoisGarrison{.temperature = 20.0 + 1e-9}, 1e6);
  EXPECT_NEAR(above / below, 1.0, 1e-3);
}

// Deep water absorbs less at high frequency, where magnesium sulphate rules, and acid water less
// at low frequency, where boric acid does.
TEST(Absorption, FollowsItsChemistry) {
  const auto at = [](FrancoisGarrison water, double f) { return absorption_db_per_km(water, f); };
  EXPECT_LT(at({.depth = 4000.0}, 3e4), at({.depth = 0.0}, 3e4));
  EXPECT_LT(at({.ph = 7.7}, 500.0), at({.ph = 8.2}, 500.0));
}

// Within 10 % of Francois & Garrison, of whose parts it is made, from 100 Hz to 1 MHz wherever both
// hold, except near the extremes of the ocean; here 15 % (p. 1671 of Ainslie & McColm).
TEST(Absorption, AinslieMcColmIsFrancoisGarrisonSimplified) {
  for (const double temperature : {0.0, 10.0, 20.0})
    for (const double ph : {7.8, 8.0, 8.2})
      for (const double depth : {0.0, 1000.0, 3000.0})
        for (double f = 200.0; f <= 1e6; f *= 1.5) {
          const double full =
              absorption_db_per_km(FrancoisGarrison{temperature, 35.0, ph, depth}, f);
          const double simple =
              absorption_db_per_km(AinslieMcColm{temperature, 35.0, ph, depth}, f);
          EXPECT_NEAR(simple / full, 1.0, 0.15)
              << temperature << ' ' << ph << ' ' << depth << ' ' << f;
        }
}

// By hand, term by term, at 10 kHz: f₁ = 0.78e^{10/26} = 1.14586 kHz, f₂ = 42e^{10/17} = 75.634
// kHz: 0.106·f₁·100/(f₁² + 100) = 0.119887, 0.52(1 + 10/43)f₂·100/(f₂² + 100) = 0.832852,
// 0.00049·100·e^{−10/27} = 0.033833 dB/km.
TEST(Absorption, AinslieMcColmByHand) {
  EXPECT_NEAR(absorption_db_per_km(AinslieMcColm{}, 1e4), 0.986572, 2e-6);
}

}  // namespace
}  // namespace asdic::detail
