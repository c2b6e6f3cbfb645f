#include <gtest/gtest.h>

#include "raytrace/ocean/absorption.h"
#include "support/csv.h"

namespace asdic::detail {
namespace {

// Ten significant digits are printed. The rows cover both branches of the pure-water term
// (T below and above 20 °C), 100 Hz to 10 kHz and more, and depths to 4000 m.
TEST(Absorption, PhysicsReference) {
  const support::Csv csv("physics-reference/absorption.csv");
  bool cold = false, warm = false;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double frequency = csv["f_Hz"][row];
    const FrancoisGarrison water = {.temperature = csv["T_degC"][row],
                                    .salinity = csv["S_psu"][row],
                                    .ph = csv["pH"][row],
                                    .depth = csv["depth_m"][row]};
    (water.temperature < 20.0 ? cold : warm) = true;
    const double expected = csv["francois_garrison_dB_km"][row];
    EXPECT_NEAR(absorption_db_per_km(water, frequency), expected, 1e-9 * expected) << row;
    const double thorp = csv["thorp_dB_km"][row];
    EXPECT_NEAR(absorption_db_per_km(Thorp{}, frequency), thorp, 1e-9 * thorp) << row;
  }
  EXPECT_TRUE(cold && warm);
}

}  // namespace
}  // namespace asdic::detail
