#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/ocean/sound_speed.h"
#include "support/csv.h"

namespace asdic::detail {
namespace {

// Munk, JASA 55, 220 (1974). The table prints ten significant digits: half a unit in the tenth is
// 5e-10 of the value, doubled for the leading digit 1. dc/dz vanishes on the axis.
TEST(SoundSpeedProfile, MunkProfileAndDerivatives) {
  const auto water = SoundSpeedProfile::munk();
  const support::Csv csv("physics-reference/munk_profile.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const SoundSpeed s = water.at(csv["depth_m"][row]);
    EXPECT_NEAR(s.c, csv["c"][row], 1e-9 * s.c);
    EXPECT_NEAR(s.dc_dz, csv["dcdz"][row], 1e-9 * std::abs(s.dc_dz) + 1e-18);
    EXPECT_NEAR(s.d2c_dz2, csv["d2cdz2"][row], 1e-9 * s.d2c_dz2);
  }
}

}  // namespace
}  // namespace asdic::detail
