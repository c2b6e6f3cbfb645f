#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"
#include "study/sampling/design.h"
#include "study/sampling/law.h"
#include "support/kolmogorov.h"

namespace asdic::detail::study {
namespace {

const std::vector<std::pair<const char*, ContinuousLaw>> every_law{
    {"uniform", Uniform{-3.0, 8.0}},
    {"normal", Normal{10.0, 3.0}},
    {"log_normal", LogNormal{5.0, 0.7}},
    {"triangular", Triangular{-1.0, 0.5, 4.0}},
    {"rayleigh", Weibull::rayleigh(7.0)},
    {"weibull", Weibull{1.7, 9.0}},
    {"left triangle", Triangular{0.0, 0.0, 1.0}},
    {"right triangle", Triangular{0.0, 1.0, 1.0}}};

TEST(Laws, QuantileInvertsBothTails) {
  for (const auto& [name, law] : every_law)
    for (const double p : {1e-12, 1e-6, 0.01, 0.3, 0.5, 0.9}) {
      // Rounding of x moves a tail by density·ε|x|, below 2e-15 for all of these.
      const Tails low = tails(law, quantile(law, {p, 1.0 - p}));
      EXPECT_NEAR(low.lower, p, 1e-9 * p + 2e-15) << name << ' ' << p;
      const Tails high = tails(law, quantile(law, {1.0 - p, p}));
      EXPECT_NEAR(high.upper, p, 1e-9 * p + 2e-15) << name << ' ' << p;
    }
}

TEST(Laws, MomentsAreThoseOfTheBooks) {
  // Mean by the midpoint rule over u; 20000 points leave 1e-3 of a deviation in the heaviest tail.
  const auto mean = [](const ContinuousLaw& law) {
    double sum = 0.0;
    for (int i = 0; i < 20000; ++i) sum += CutLaw(law).quantile((i + 0.5) / 20000.0);
    return sum / 20000.0;
  };
  EXPECT_NEAR(mean(Uniform{-3.0, 8.0}), 2.5, 1e-9);
  EXPECT_NEAR(mean(Normal{10.0, 3.0}), 10.0, 1e-9);
  EXPECT_NEAR(mean(LogNormal{5.0, 0.7}), 5.0 * std::exp(0.245), 5e-3);
  EXPECT_NEAR(mean(Triangular{-1.0, 0.5, 4.0}), 3.5 / 3.0, 1e-5);
  EXPECT_NEAR(mean(Weibull::rayleigh(7.0)), 7.0, 1e-3);
  EXPECT_NEAR(mean(Weibull::of_mean(1.7, 8.0)), 8.0, 2e-3);
}

TEST(Laws, NormalQuantileKnownDigits) {
  // Abramowitz & Stegun, Table 26.5: Q(1.959963984540054) = 0.025, Q(3.090232306167814) = 0.001.
  EXPECT_NEAR(normal_upper_quantile(0.025), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normal_upper_quantile(0.001), 3.090232306167814, 1e-13);
  EXPECT_NEAR(normal_upper_quantile(1e-10), 6.361340902404056, 1e-12);
  EXPECT_EQ(normal_upper_quantile(0.5), 0.0);
}

TEST(Laws, DrawsFollowTheirLawCutOrNot) {
  // Kolmogorov–Smirnov at 1e-6: √n·D < 2.69.
  constexpr int n = 4000;
  for (const auto& [name, law] : every_law)
    for (const bool cut : {false, true}) {
      const CutLaw drawn =
          cut ? CutLaw(law, CutLaw(law).quantile(0.2), CutLaw(law).quantile(0.9)) : CutLaw(law);
      std::vector<double> x;
      for (std::uint64_t i = 0; i < n; ++i) x.push_back(drawn.quantile(uniform_draw(3, i, 0)));
      for (const double value : x) {
        EXPECT_GE(value, drawn.low());
        EXPECT_LE(value, drawn.high());
      }
      const auto own = [&](double value) { return drawn.distribution(value); };
      const auto squared = [&](double value) { return own(value) * own(value); };
      EXPECT_LT(support::kolmogorov_distance(x, own) * std::sqrt(double(n)), 2.69) << name;
      EXPECT_GT(support::kolmogorov_distance(x, squared) * std::sqrt(double(n)), 2.69) << name;
    }
}

TEST(Laws, CutFarOutKeepsItsDigits) {
  // P(Z > 9)/P(Z > 8) = 1.8e-4: the upper tail alone has the digits.
  const CutLaw far(Normal{0.0, 1.0}, 8.0, 9.0);
  EXPECT_GT(far.share(), 0.0);
  EXPECT_NEAR(far.quantile(0.5), 8.0846, 1e-3);  // −ln 2/8.12 further: Q(z) ≈ e^{−z²/2}/(z√2π)
  const CutLaw near(Normal{0.0, 1.0}, -9.0, -8.0);
  EXPECT_NEAR(near.quantile(0.5), -far.quantile(0.5), 1e-12);
}

TEST(Laws, EndWhereNothingMoreIsDrawn) {
  const auto ends = [](const CutLaw& law) { return std::pair(law.ends().low, law.ends().high); };
  EXPECT_EQ(ends(CutLaw(Uniform{2.0, 5.0})), std::pair(2.0, 5.0));
  EXPECT_EQ(ends(CutLaw(Uniform{2.0, 5.0}, 3.0, 9.0)), std::pair(3.0, 5.0));
  EXPECT_EQ(ends(CutLaw(Triangular{-1.0, 0.5, 4.0})), std::pair(-1.0, 4.0));
  EXPECT_EQ(ends(CutLaw(Normal{}, -2.0)), std::pair(-2.0, infinity));
  EXPECT_EQ(ends(CutLaw(LogNormal{})), std::pair(0.0, infinity));
  EXPECT_EQ(ends(CutLaw(Weibull{}, 0.0, 20.0)), std::pair(0.0, 20.0));
}

}  // namespace
}  // namespace asdic::detail::study
