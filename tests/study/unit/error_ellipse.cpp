#include "study/summary/error_ellipse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "core/units.h"

namespace asdic::detail::study {
namespace {

/// Normal errors with deviations a along and b across an axis of this bearing, about a bias.
struct Normal {
  double a = 1.0, b = 1.0, bearing = 0.0, bias_x = 0.0, bias_y = 0.0;

  void draw(RandomStream& random, double& x, double& y) const {
    const double u = a * random.normal(), v = b * random.normal();
    x = bias_x + u * std::sin(bearing) + v * std::cos(bearing);
    y = bias_y + u * std::cos(bearing) - v * std::sin(bearing);
  }
};

ErrorEllipse of_draws(const Normal& law, std::uint32_t set, int count, double confidence,
                      Vec2* next = nullptr) {
  RandomStream random(7, Draw::study_noise, set, static_cast<std::uint64_t>(count));
  std::vector<double> x(static_cast<std::size_t>(count)), y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) law.draw(random, x[i], y[i]);
  if (next != nullptr) law.draw(random, next->x(), next->y());
  return error_ellipse(x, y, confidence);
}

// Of a million errors the axes are the deviations times √(−2 ln 0.05), to some 0.1 %.
TEST(ErrorEllipse, IsTheClosedFormOfMany) {
  const Normal law{.a = 30.0, .b = 10.0, .bearing = radians(140.0), .bias_x = 5.0, .bias_y = -3.0};
  const ErrorEllipse found = of_draws(law, 0, 1'000'000, 0.95);
  const double r = std::sqrt(-2.0 * std::log(0.05));
  EXPECT_NEAR(found.major, 30.0 * r, 0.005 * 30.0 * r);  // deviation 1/√(2n): 0.07 %
  EXPECT_NEAR(found.minor, 10.0 * r, 0.005 * 10.0 * r);
  EXPECT_NEAR(degrees(found.bearing), 140.0, 0.2);
  EXPECT_NEAR(found.mean_x, 5.0, 0.15);  // 5 deviations of at most 0.03 m
  EXPECT_NEAR(found.mean_y, -3.0, 0.15);
  EXPECT_NEAR(found.inside, 0.95, 0.0015);
  EXPECT_NEAR(found.rms, std::sqrt(900.0 + 100.0 + 34.0), 0.2);
}

// Four errors by hand: covariance diag(8/3, 2/3) about 0, with n = 4 and c = 0.5
// r² = 15/4·(0.5^{−1} − 1) = 15/4.
TEST(ErrorEllipse, OfFourByHand) {
  const std::vector<double> x{2.0, -2.0, 0.0, 0.0}, y{0.0, 0.0, 1.0, -1.0};
  const ErrorEllipse found = error_ellipse(x, y, 0.5);
  EXPECT_NEAR(found.major, std::sqrt(15.0 / 4.0 * 8.0 / 3.0), 1e-12);
  EXPECT_NEAR(found.minor, std::sqrt(15.0 / 4.0 * 2.0 / 3.0), 1e-12);
  EXPECT_NEAR(degrees(found.bearing), 90.0, 1e-9);
  EXPECT_EQ(found.inside, 1.0);
  EXPECT_TRUE(std::isnan(
      error_ellipse(std::vector<double>{1.0, 2.0}, std::vector<double>{0.0, 1.0}, 0.95).major));
}

// The next error is within the ellipse with the probability that it says, of few errors too:
// counted over 20 000 sets, within 5 deviations of 0.0015. The ellipse of the covariance taken for
// known, −2 ln(1 − c), holds far fewer.
TEST(ErrorEllipse, HoldsTheNextError) {
  const Normal law{.a = 3.0, .b = 1.0, .bearing = 0.4, .bias_x = 2.0};
  for (const int count : {5, 12, 60}) {
    int held = 0, held_if_known = 0;
    constexpr int sets = 20'000;
    const double n = count, known = -2.0 * std::log(0.05);
    const double squared = (n * n - 1.0) / n * (std::pow(0.05, -2.0 / (n - 2.0)) - 1.0);
    for (std::uint32_t s = 0; s < sets; ++s) {
      Vec2 next = Vec2::Zero();
      const ErrorEllipse e = of_draws(law, s + 1, count, 0.95, &next);
      const double dx = next.x() - e.mean_x, dy = next.y() - e.mean_y;
      const double u = dx * std::sin(e.bearing) + dy * std::cos(e.bearing);
      const double v = dx * std::cos(e.bearing) - dy * std::sin(e.bearing);
      const double distance = std::pow(u / e.major, 2) + std::pow(v / e.minor, 2);
      held += distance <= 1.0 ? 1 : 0;
      held_if_known += distance <= known / squared ? 1 : 0;
    }
    EXPECT_NEAR(held / double(sets), 0.95, 5.0 * 0.00154) << count;
    if (count <= 12) {
      EXPECT_LT(held_if_known / double(sets), 0.93) << count;
    }
  }
}

// Intervals of bias, axes and bearing hold the truth as often as they say: counted over 4000 sets
// of 200, of normal errors and of ones with heavier tails, for which 1/√(2n) would be too narrow.
TEST(ErrorEllipse, IntervalsHoldTheTruth) {
  constexpr int sets = 4000, count = 200;
  const Normal law{.a = 3.0, .b = 1.0, .bearing = 0.7, .bias_x = 1.0};
  for (const bool heavy : {false, true}) {
    int bias = 0, major = 0, minor = 0, bearing = 0, naive = 0;
    const double n = count;
    const double r = std::sqrt((n * n - 1.0) / n * (std::pow(0.05, -2.0 / (n - 2.0)) - 1.0));
    for (std::uint32_t s = 0; s < sets; ++s) {
      RandomStream random(9, Draw::study_noise, s, heavy ? 1 : 0);
      std::vector<double> x(count), y(count);
      for (std::size_t i = 0; i < x.size(); ++i) {
        // Each error of its own size, of mean square 1: Laplace's law has it exponential.
        const double size = heavy ? std::sqrt(-std::log(random.uniform())) : 1.0;
        Normal own = law;
        own.a *= size;
        own.b *= size;
        own.draw(random, x[i], y[i]);
      }
      const ErrorEllipse e = error_ellipse(x, y, 0.95);
      const auto holds = [](const Interval& i, double truth) {
        return i.low <= truth && truth <= i.high ? 1 : 0;
      };
      bias += holds(e.mean_x_interval, 1.0);
      major += holds(e.major_interval, 3.0 * r);
      minor += holds(e.minor_interval, r);
      bearing += std::abs(std::remainder(e.bearing - 0.7, pi)) <= e.bearing_half ? 1 : 0;
      const double half = 1.96 / std::sqrt(2.0 * n);  // of normal errors: σ_λ/λ = √(2/n)
      naive += holds({e.major * std::exp(-half), e.major * std::exp(half)}, 3.0 * r);
    }
    // First-order intervals of 200 errors; of heavy tails fourth moments are themselves uncertain.
    const double low = heavy ? 0.90 : 0.93;
    for (const int held : {bias, major, minor, bearing}) {
      EXPECT_GT(held / double(sets), low) << heavy;
      EXPECT_LT(held / double(sets), 0.97) << heavy;
    }
    if (heavy) {
      EXPECT_LT(naive / double(sets), 0.85);
    }
  }
}

}  // namespace
}  // namespace asdic::detail::study
