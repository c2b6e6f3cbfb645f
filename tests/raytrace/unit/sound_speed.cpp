#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "core/error.h"
#include "raytrace/ocean/sound_speed.h"

namespace asdic::detail {
namespace {

constexpr std::array every_rule = {Interpolation::c_linear, Interpolation::n2_linear,
                                   Interpolation::spline, Interpolation::pchip,
                                   Interpolation::pchip_spline_slopes};

const std::vector<double> depth = {0.0, 40.0, 100.0, 180.0, 400.0, 1000.0, 2500.0, 5000.0};
const std::vector<double> speed = {1512.0, 1513.5, 1508.0, 1496.0, 1489.0, 1485.0, 1502.0, 1546.0};

TEST(SoundSpeedProfile, PassesThroughItsSamples) {
  for (const Interpolation rule : every_rule) {
    const auto water = SoundSpeedProfile::table(depth, speed, rule);
    ASSERT_EQ(water.intervals(), depth.size() - 1);
    for (std::size_t i = 0; i < depth.size(); ++i) {
      EXPECT_NEAR(water.at(depth[i]).c, speed[i], 1e-12 * speed[i]) << name(rule) << ' ' << i;
      if (i > 0) {
        EXPECT_NEAR(water.at(depth[i], i - 1).c, speed[i], 1e-12 * speed[i]);
      }
    }
  }
}

TEST(SoundSpeedProfile, AtASampleTheIntervalBelowHolds) {
  const auto water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  EXPECT_EQ(water.interval(-10.0), 0U);
  EXPECT_EQ(water.interval(0.0), 0U);
  EXPECT_EQ(water.interval(39.999), 0U);
  EXPECT_EQ(water.interval(40.0), 1U);
  EXPECT_EQ(water.interval(4999.0), 6U);
  EXPECT_EQ(water.interval(5000.0), 6U);
  EXPECT_EQ(water.interval(9000.0), 6U);
  EXPECT_DOUBLE_EQ(water.at(40.0).dc_dz, -5.5 / 60.0);
  EXPECT_DOUBLE_EQ(water.at(40.0, 0).dc_dz, 1.5 / 40.0);
}

// The laws as they are written in the header, computed by hand for one interval.
TEST(SoundSpeedProfile, LinearLaws) {
  const std::vector<double> z = {100.0, 300.0}, c = {1500.0, 1520.0};
  const auto line = SoundSpeedProfile::table(z, c, Interpolation::c_linear);
  EXPECT_DOUBLE_EQ(line.at(150.0).c, 1505.0);
  EXPECT_DOUBLE_EQ(line.at(150.0).dc_dz, 0.1);
  EXPECT_EQ(line.at(150.0).d2c_dz2, 0.0);
  EXPECT_EQ(line.law(0).z0, 100.0);

  const auto n2 = SoundSpeedProfile::table(z, c, Interpolation::n2_linear);
  const double middle = 0.5 * (1.0 / (1500.0 * 1500.0) + 1.0 / (1520.0 * 1520.0));
  EXPECT_NEAR(n2.at(200.0).c, 1.0 / std::sqrt(middle), 1e-11);
  EXPECT_DOUBLE_EQ(n2.law(0).a[0], 1.0 / (1500.0 * 1500.0));
}

TEST(SoundSpeedProfile, ContinuityOfEachRule) {
  const auto jump = [](const SoundSpeedProfile& water, std::size_t i,
                       double SoundSpeed::*derivative) {
    return std::abs(water.at(depth[i], i).*derivative - water.at(depth[i], i - 1).*derivative);
  };
  const auto spline = SoundSpeedProfile::table(depth, speed, Interpolation::spline);
  const auto pchip = SoundSpeedProfile::table(depth, speed, Interpolation::pchip);
  const auto line = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  for (std::size_t i = 1; i + 1 < depth.size(); ++i) {
    // Gradients are of order 0.1 /s and curvatures of 1e-3 /(m·s): rounding leaves 1e-15 of them.
    EXPECT_LT(jump(spline, i, &SoundSpeed::dc_dz), 1e-14);
    EXPECT_LT(jump(spline, i, &SoundSpeed::d2c_dz2), 1e-16);
    EXPECT_LT(jump(pchip, i, &SoundSpeed::dc_dz), 1e-14);
    EXPECT_GT(jump(line, i, &SoundSpeed::dc_dz), 1e-3);  // this profile has a kink at every sample
  }
}

// Not-a-knot: the spline through samples of a cubic is that cubic, everywhere, and through three
// samples it is their parabola, through two their line.
TEST(SoundSpeedProfile, SplineReproducesPolynomials) {
  for (std::size_t n : {2U, 3U, 4U, 5U, 8U}) {
    const std::array a = {1500.0, -0.03, n > 2 ? 2e-5 : 0.0, n > 3 ? -2e-9 : 0.0};
    const auto cubic = [&](double z) { return a[0] + z * (a[1] + z * (a[2] + z * a[3])); };
    const std::vector<double> z(depth.begin(), depth.begin() + static_cast<std::ptrdiff_t>(n));
    std::vector<double> c;
    for (const double zi : z) c.push_back(cubic(zi));
    const auto water = SoundSpeedProfile::table(z, c, Interpolation::spline);
    for (double at = z.front() - 10.0; at < z.back() + 10.0; at += 0.01 * z.back()) {
      EXPECT_NEAR(water.at(at).c, cubic(at), 1e-11 * 1500.0) << n << " samples, " << at << " m";
      EXPECT_NEAR(water.at(at).dc_dz, a[1] + at * (2.0 * a[2] + at * 3.0 * a[3]), 1e-12 * 1500.0);
      EXPECT_NEAR(water.at(at).d2c_dz2, 2.0 * a[2] + 6.0 * a[3] * at, 1e-13 * 1500.0);
    }
  }
}

// Through n samples of a smooth profile with spacing h the spline errs by O(h⁴): halving h divides
// the error by 16. Not-a-knot ends keep that order up to the ends; a natural spline would not.
TEST(SoundSpeedProfile, SplineIsOfFourthOrder) {
  const auto munk = SoundSpeedProfile::munk();
  const auto worst = [&](int n) {
    std::vector<double> z, c;
    for (int i = 0; i <= n; ++i) {
      z.push_back(5000.0 * i / n);
      c.push_back(munk.at(z.back()).c);
    }
    const auto water = SoundSpeedProfile::table(z, c, Interpolation::spline);
    double error = 0.0;
    for (double at = 0.0; at <= 5000.0; at += 1.0)
      error = std::max(error, std::abs(water.at(at).c - munk.at(at).c));
    return error;
  };
  EXPECT_NEAR(std::log2(worst(100) / worst(200)), 4.0, 0.15);
}

TEST(SoundSpeedProfile, PchipIsFlatAtAnExtremum) {
  const auto water = SoundSpeedProfile::table(depth, speed, Interpolation::pchip);
  EXPECT_EQ(water.at(40.0).dc_dz, 0.0);
  EXPECT_EQ(water.at(1000.0).dc_dz, 0.0);
}

// Fritsch & Butland's mean by hand at the inner sample of three: h = 1, 2 m, δ = 4, 1 /s:
// (w₁ + w₂)/(w₁/δ₁ + w₂/δ₂) with w₁ = h₁ + 2h₂ = 5, w₂ = 2h₁ + h₂ = 4: 9/(5/4 + 4) = 12/7.
// End slope ((2h₁ + h₂)δ₁ − h₁δ₂)/(h₁ + h₂) = (16 − 1)/3 = 5, and (5·1 − 2·4)/3 < 0, so 0.
TEST(SoundSpeedProfile, PchipSlopesByHand) {
  const std::vector<double> z = {0.0, 1.0, 3.0}, c = {1500.0, 1504.0, 1506.0};
  const auto water = SoundSpeedProfile::table(z, c, Interpolation::pchip);
  EXPECT_NEAR(water.at(0.0).dc_dz, 5.0, 1e-12);
  EXPECT_NEAR(water.at(1.0).dc_dz, 12.0 / 7.0, 1e-12);
  EXPECT_NEAR(water.at(3.0).dc_dz, 0.0, 1e-12);
}

TEST(SoundSpeedProfile, GoesOnByTheLawOfItsEnds) {
  const std::vector<double> z = {100.0, 300.0}, c = {1500.0, 1520.0};
  for (const Interpolation rule : every_rule) {
    const auto water = SoundSpeedProfile::table(z, c, rule);
    EXPECT_DOUBLE_EQ(water.at(50.0).c, water.at(50.0, 0).c);
    EXPECT_DOUBLE_EQ(water.at(700.0).c, water.at(700.0, 0).c);
  }
  EXPECT_DOUBLE_EQ(SoundSpeedProfile::table(z, c, Interpolation::c_linear).at(0.0).c, 1490.0);
}

// Where the clamped spline is monotone by itself its slopes stand: c″ is then continuous at the
// inner samples, and the ends have the slope of the parabola through three samples. Here
// c = 1500 + z²/1000, for which both are exact.
TEST(SoundSpeedProfile, SplineSlopesStandWhereTheyAreMonotone) {
  const std::vector<double> z = {0.0, 50.0, 80.0, 150.0, 300.0};
  std::vector<double> c;
  for (const double x : z) c.push_back(1500.0 + 1e-3 * x * x);
  const auto water = SoundSpeedProfile::table(z, c, Interpolation::pchip_spline_slopes);
  for (double x = 0.0; x <= 300.0; x += 1.7) {
    EXPECT_NEAR(water.at(x).c, 1500.0 + 1e-3 * x * x, 1e-11);
    EXPECT_NEAR(water.at(x).d2c_dz2, 2e-3, 1e-12);
  }
}

// Elsewhere they are held between 0 and three times the smaller neighbouring secant. Secants here:
// 0.2, 0.01, then −0.1 (an extremum between the last two, slope 0); first slope: 0.2 + (0.2 −
// 0.01)/2 by the parabola; the last, −0.155, stands too.
TEST(SoundSpeedProfile, SplineSlopesAreLimited) {
  const std::vector<double> z = {0.0, 100.0, 200.0, 300.0}, c = {1500.0, 1520.0, 1521.0, 1511.0};
  const auto water = SoundSpeedProfile::table(z, c, Interpolation::pchip_spline_slopes);
  EXPECT_NEAR(water.at(0.0).dc_dz, 0.295, 1e-13);
  EXPECT_NEAR(water.at(100.0).dc_dz, 0.03, 1e-13);
  EXPECT_NEAR(water.at(200.0).dc_dz, 0.0, 1e-13);
  EXPECT_NEAR(water.at(300.0).dc_dz, -0.155, 1e-13);
}

// Falling 1/c² reaches 0 (c = ∞) and falling c reaches 0 m/s far outside; both are held first.
TEST(SoundSpeedProfile, ExtrapolationIsHeldBeforeItMeansNothing) {
  const std::vector<double> z = {0.0, 100.0}, rising = {1500.0, 1600.0}, falling = {1600.0, 1500.0};
  for (const Interpolation rule : every_rule) {
    for (const double far : {-1e6, 1e6}) {
      const SoundSpeed up = SoundSpeedProfile::table(z, rising, rule).at(far);
      const SoundSpeed down = SoundSpeedProfile::table(z, falling, rule).at(far);
      for (const SoundSpeed& s : {up, down}) {
        EXPECT_TRUE(s.c == 3200.0 || s.c == 750.0) << name(rule) << ' ' << s.c;
        EXPECT_EQ(s.dc_dz, 0.0);
        EXPECT_EQ(s.d2c_dz2, 0.0);
      }
    }
  }
}

TEST(SoundSpeedProfile, Isovelocity) {
  const auto water = SoundSpeedProfile::isovelocity(1480.0);
  ASSERT_EQ(water.intervals(), 1U);
  for (const double z : {-100.0, 0.0, 1.0, 5000.0}) {
    EXPECT_EQ(water.at(z).c, 1480.0);
    EXPECT_EQ(water.at(z).dc_dz, 0.0);
    EXPECT_EQ(water.at(z).d2c_dz2, 0.0);
  }
}

TEST(SoundSpeedProfile, OneSampleIsTheSameSpeedEverywhere) {
  const std::vector<double> z = {700.0}, c = {1490.0};
  for (const Interpolation rule : every_rule)
    EXPECT_NEAR(SoundSpeedProfile::table(z, c, rule).at(3.0).c, 1490.0, 1e-9);
}

std::string where_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.fault().where;
  }
  return "no error";
}

TEST(SoundSpeedProfile, NamesTheSampleAtFault) {
  using Vector = std::vector<double>;
  const auto fault = [](const Vector& z, const Vector& c, Interpolation rule) {
    return where_of([&] { (void)SoundSpeedProfile::table(z, c, rule); });
  };
  const auto linear = Interpolation::c_linear;
  EXPECT_EQ(fault({}, {}, linear), "depth");
  EXPECT_EQ(fault({0.0, 1.0}, {1500.0}, linear), "speed");
  EXPECT_EQ(fault({0.0, 2.0, 2.0}, {1500.0, 1500.0, 1500.0}, linear), "depth[2]");
  EXPECT_EQ(fault({0.0, std::nan("")}, {1500.0, 1500.0}, linear), "depth[1]");
  EXPECT_EQ(fault({0.0, 1.0}, {1500.0, -1498.0}, linear), "speed[1]");
  EXPECT_EQ(fault({0.0, 1.0}, {INFINITY, 1500.0}, linear), "speed[0]");
  // A spike that no ocean has makes a cubic spline swing below half its lowest sample.
  const Vector z = {0.0, 1.0, 2.0, 1000.0, 1001.0, 1002.0};
  const Vector c = {1500.0, 1500.0, 1700.0, 1400.0, 1600.0, 1500.0};
  EXPECT_EQ(fault(z, c, Interpolation::spline), "interpolation");
  EXPECT_EQ(fault(z, c, Interpolation::pchip), "no error");
}

TEST(SoundSpeedProfile, RefusesMeaninglessLaws) {
  EXPECT_EQ(where_of([] { (void)SoundSpeedProfile::isovelocity(0.0); }), "speed");
  EXPECT_EQ(where_of([] { (void)SoundSpeedProfile::munk({.axis_speed = -1.0}); }), "axis_speed");
  EXPECT_EQ(where_of([] { (void)SoundSpeedProfile::munk({.axis_depth = INFINITY}); }),
            "axis_depth");
  EXPECT_EQ(where_of([] { (void)SoundSpeedProfile::munk({.scale_depth = 0.0}); }), "scale_depth");
  EXPECT_EQ(where_of([] { (void)SoundSpeedProfile::munk({.perturbation = -0.1}); }),
            "perturbation");
}

}  // namespace
}  // namespace asdic::detail
