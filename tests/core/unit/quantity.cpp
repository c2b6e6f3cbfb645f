#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {
namespace {

TEST(Quantity, SaysWhatItIs) {
  EXPECT_EQ(Quantity{}.expected(), "a finite number");
  EXPECT_EQ((Quantity{.noun = "phase", .unit = "degrees"}).expected(), "a finite phase in degrees");
  EXPECT_EQ(quantity::elevation.in_degrees().expected(), "an elevation from -90 to 90 degrees");
  EXPECT_EQ((Quantity{.low = 0.0, .above = true}).expected(), "a number above 0");
  EXPECT_EQ((Quantity{.high = 3.0}).expected(), "a number of at most 3");
  EXPECT_EQ(quantity::duration.expected(), "a duration from 1e-06 to 100000 s");
}

TEST(Quantity, HoldsWhatItSays) {
  EXPECT_TRUE(quantity::depth.holds(0.0));
  EXPECT_FALSE(quantity::duration.holds(0.0));
  EXPECT_FALSE(quantity::depth.holds(12000.1));
  EXPECT_FALSE(Quantity{}.holds(infinity));
}

TEST(AngleQuantity, HasTheSameBoundsInRadians) {
  const Quantity grazing = quantity::grazing.in_radians();
  EXPECT_EQ(grazing.low, 0.0);
  EXPECT_EQ(grazing.high, pi / 2.0);
  EXPECT_EQ(grazing.noun, "grazing angle");
}

TEST(Text, NearestNameForgivesALetterOrAUnit) {
  const std::vector<std::string> names{"duration", "heading_deg", "window"};
  EXPECT_EQ(nearest_name("duraton", names), "duration");
  EXPECT_EQ(nearest_name("heading", names), "heading_deg");
  EXPECT_EQ(nearest_name("absorption", names), "");
}

}  // namespace
}  // namespace asdic::detail
