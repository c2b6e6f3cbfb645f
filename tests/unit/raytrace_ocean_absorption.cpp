#include <gtest/gtest.h>

#include "raytrace/ocean/absorption.h"

namespace asdic {
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

}  // namespace
}  // namespace asdic
