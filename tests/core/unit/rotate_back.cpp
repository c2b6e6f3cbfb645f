#include "core/rotate_back.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace asdic::detail {
namespace {

/// z·e^{−i2π·cycles} by the library's sine and cosine. What is left of the whole turns is exact.
std::complex<double> plainly(double cycles, std::complex<double> z) {
  return z * std::polar(1.0, -2.0 * pi * (cycles - std::round(cycles)));
}

TEST(RotateBack, IsThePlainRotation) {
  double worst = 0.0;
  for (const double scale : {1e-6, 0.5, 1.0, 3.0, 1e4, 1e9})
    for (int i = -1000; i <= 1000; ++i) {
      const double cycles = scale * (i + 0.37) / 1000.0;
      std::complex<double> z{0.6, -0.8};
      const std::complex<double> expected = plainly(cycles, z);
      double re = z.real(), im = z.imag();
      rotate_back(cycles, re, im);
      worst = std::max(worst, std::abs(std::complex<double>(re, im) - expected));
    }
  EXPECT_LT(worst, 3e-11);
  EXPECT_GT(worst, 0.0);  // another way than the plain one
}

TEST(RotateBack, HalfTurnsAreNoCliff) {
  for (const double whole : {-3.0, 0.0, 1e6})
    for (const double beside : {-1e-9, 0.0, 1e-9}) {
      double re = 1.0, im = 0.0;
      rotate_back(whole + 0.5 + beside, re, im);
      EXPECT_NEAR(re, -1.0, 3e-11);
      EXPECT_NEAR(im, std::sin(2.0 * pi * beside), 1e-9 + 3e-11);
    }
}

TEST(RotateBack, NearestIsThatOfTheLibrary) {
  for (const double x : {-7.4, -7.6, -0.4, 0.0, 0.3, 0.7, 12345.49, 12345.51, 1e15})
    EXPECT_EQ(nearest(x), std::round(x)) << x;
}

}  // namespace
}  // namespace asdic::detail
