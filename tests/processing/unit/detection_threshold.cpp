#include "processing/detection_threshold.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"

namespace asdic::detail {
namespace {

/// ∫ P_d(S)·e^{−S/s}/s dS by Simpson's rule over t, S = 40·s·t³: what a target of Swerling 1 is
/// detected with. The steps are fine where P_d rises; the rule's error and the rest are below 1e-9.
double over_swerling_1(double mean, double false_alarm, double cells) {
  constexpr int steps = 4000;
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double t = 1.0 / steps * i, u = 40.0 * t * t * t;
    const double weight = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum +=
        weight * 120.0 * t * t * std::exp(-u) * detection_probability(mean * u, false_alarm, cells);
  }
  return sum / steps / 3.0;
}

TEST(DetectionThreshold, WithoutAnEchoTheProbabilityIsThatOfAFalseAlarm) {
  for (const double p : {1e-8, 1e-4, 0.1})
    for (const double cells : {4.0, 24.0, infinity})
      EXPECT_NEAR(detection_probability(0.0, p, cells), p, 1e-14);
}

// Marcum's Q₁(a, a) = ½[1 + e^{−a²}·I₀(a²)]; here a² = 2S = 2x.
TEST(DetectionThreshold, OverAKnownBackgroundItIsMarcumsQ) {
  for (const double p : {1e-6, 1e-4, 0.05}) {
    const double x = -std::log(p);
    EXPECT_NEAR(detection_probability(x, p, infinity),
                0.5 * (1.0 + std::exp(-2.0 * x) * std::cyl_bessel_i(0.0, 2.0 * x)), 1e-12)
        << p;
  }
}

// Averaged over a Rayleigh amplitude: eqs (4) and (5) of docs/theory/studies.md.
TEST(DetectionThreshold, OverSwerling1ItIsTheClosedForm) {
  for (const double p : {1e-6, 1e-3})
    for (const double mean : {0.5, 10.0, 100.0}) {
      EXPECT_NEAR(over_swerling_1(mean, p, infinity), std::pow(p, 1.0 / (1.0 + mean)), 1e-8);
      for (const double m : {6.0, 24.0})
        EXPECT_NEAR(over_swerling_1(mean, p, m),
                    std::pow(1.0 + (std::pow(p, -1.0 / m) - 1.0) / (1.0 + mean), -m), 1e-8);
    }
}

// The law of the fluctuation in the weights is the mean over it: of Swerling 1 against its closed
// forms, of Swerling 3 (four degrees of freedom, density 4S/s²·e^{−2S/s}) by Simpson's rule.
TEST(DetectionThreshold, OfAnEchoThatFluctuates) {
  EXPECT_EQ(fluctuation_shape(Fluctuation::swerling_2), 1.0);
  EXPECT_EQ(fluctuation_shape(Fluctuation::swerling_3), 2.0);
  EXPECT_TRUE(std::isinf(fluctuation_shape(Fluctuation::none)));
  for (const double p : {1e-6, 1e-3})
    for (const double mean : {0.5, 10.0, 100.0}) {
      EXPECT_NEAR(detection_probability(mean, p, infinity, 1.0), std::pow(p, 1.0 / (1.0 + mean)),
                  1e-12);
      for (const double m : {6.0, 24.0}) {
        EXPECT_NEAR(detection_probability(mean, p, m, 1.0),
                    std::pow(1.0 + (std::pow(p, -1.0 / m) - 1.0) / (1.0 + mean), -m), 1e-12);
        constexpr int steps = 4000;
        double sum = 0.0;
        for (int i = 0; i <= steps; ++i) {
          const double t = 1.0 / steps * i, u = 40.0 * t * t * t;
          const double weight = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
          sum += weight * 120.0 * t * t * 4.0 * u * std::exp(-2.0 * u) *
                 detection_probability(mean * u, p, m);
        }
        EXPECT_NEAR(detection_probability(mean, p, m, 2.0), sum / steps / 3.0, 1e-7);
      }
    }
  EXPECT_NEAR(detection_probability(power_from_db(detection_threshold_db(1e-4, 24.0, 0.5, 1.0)),
                                    1e-4, 24.0, 1.0),
              0.5, 1e-9);
}

TEST(DetectionThreshold, IsReachedHalfOfTheTime) {
  for (const double p : {1e-9, 1e-6, 1e-4, 1e-2}) {
    for (const double cells : {8.0, 24.0, infinity})
      EXPECT_NEAR(detection_probability(power_from_db(detection_threshold_db(p, cells)), p, cells),
                  0.5, 1e-9);
    // Albersheim's fit, IEEE Proc. 69, 839 (1981): ln(0.62/P_fa) at P_d = 0.5, good to 0.2 dB.
    EXPECT_NEAR(detection_threshold_db(p, infinity), db_from_power(std::log(0.62 / p)), 0.2) << p;
    EXPECT_GT(detection_threshold_db(p, 8.0), detection_threshold_db(p, 24.0));
    EXPECT_GT(detection_threshold_db(p, 24.0), detection_threshold_db(p, infinity));
  }
  // A strong echo's weights reach far beyond what e^{−S} can hold.
  EXPECT_NEAR(detection_probability(1e4, 1e-6, 24.0), 1.0, 1e-12);
}

}  // namespace
}  // namespace asdic::detail
