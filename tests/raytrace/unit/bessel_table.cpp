#include "raytrace/math/bessel_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace asdic::detail {
namespace {

// ⅜·h⁴/384 of a function whose fourth derivative is at most ⅜ by 1; rounding of x·16.
TEST(BesselTable, IsTheBesselFunction) {
  const BesselTable table(80.0);
  for (double x = 0.0; x <= 80.0; x += 0.0137)
    EXPECT_NEAR(table(x), std::cyl_bessel_j(0.0, x), 1.6e-8) << x;
}

}  // namespace
}  // namespace asdic::detail
