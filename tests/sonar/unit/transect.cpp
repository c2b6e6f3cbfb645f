#include "raytrace/ocean/transect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/units.h"
#include "raytrace/ocean/slice.h"

namespace asdic::detail {
namespace {

/// From (1000, 2000) towards the east.
const Transect eastward = {.x = 1000.0, .y = 2000.0, .bearing = 0.5 * pi};

/// The ocean in the plane that leaves a place on the map along a bearing.
Environment ocean_along(const Environment& ocean, const Transect& transect, double east,
                        double north, double bearing) {
  return slice(ocean, transect.range_of(east, north), std::cos(bearing - transect.bearing));
}

/// A front and a slope with two materials.
Environment slope_and_front() {
  Environment ocean;
  const std::vector<double> r = {0.0, 4000.0, 10000.0}, z = {0.0, 100.0, 500.0};
  const std::vector<double> c = {1500.0, 1495.0, 1490.0, 1510.0, 1500.0,
                                 1490.0, 1520.0, 1505.0, 1490.0};
  ocean.section = SoundSpeedSection(r, z, c);
  const std::vector<double> depth = {400.0, 300.0, 100.0};
  ocean.bottom.shape = BoundaryShape(r, depth, ShapeInterpolation::smooth,
                                     {Rigid{}, FluidHalfSpace{.speed = 1700.0}, Vacuum{}});
  ocean.bottom.depth = 400.0;
  return ocean;
}

TEST(Transect, RangeIsTheDistanceAlong) {
  EXPECT_NEAR(eastward.range_of(4000.0, -500.0), 3000.0, 1e-9);
  const Transect northeast = {.bearing = 0.25 * pi};
  EXPECT_NEAR(northeast.range_of(100.0, 100.0), 100.0 * std::sqrt(2.0), 1e-12);
}

// In any vertical plane the ocean at s is the ocean of the place that s leads to. 1e-9: ranges of
// 1e4 m are made longer and looked up again; materials are compared away from their edges.
TEST(Transect, AnOceanAlongAnyBearingIsTheOceanThere) {
  const Environment ocean = slope_and_front();
  for (const double bearing_deg : {90.0, 60.0, 0.0, 170.0, 200.0, 270.0, 359.0}) {
    const double bearing = radians(bearing_deg), east = 3500.0, north = -700.0;
    const Environment plane = ocean_along(ocean, eastward, east, north, bearing);
    for (double s = 0.0; s < 20000.0; s += 271.0) {
      const double range =
          eastward.range_of(east + s * std::sin(bearing), north + s * std::cos(bearing));
      EXPECT_NEAR(plane.bottom.depth_at(s), ocean.bottom.depth_at(range), 1e-9) << bearing_deg;
      for (const double z : {0.0, 70.0, 300.0})
        EXPECT_NEAR(sound_speed(plane, s, z).c, sound_speed(ocean, range, z).c, 1e-9);
      if (range < 10000.0) {
        EXPECT_EQ(plane.bottom.material_at(s).index(), ocean.bottom.material_at(range).index())
            << bearing_deg << ' ' << range;
      }
    }
    EXPECT_EQ(plane.bottom.depth, plane.bottom.depth_at(0.0));
  }
}

TEST(Transect, AcrossItTheOceanIsLayered) {
  const Environment plane = ocean_along(slope_and_front(), eastward, 5000.0, 0.0, 0.0);
  EXPECT_TRUE(is_layered(plane));
  EXPECT_EQ(plane.bottom.depth, 300.0);
  EXPECT_NEAR(plane.water.at(0.0).c, 1510.0, 1e-9);
}

TEST(Transect, AUniformOceanStaysAsItIs) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::munk();
  EXPECT_TRUE(is_layered(ocean_along(ocean, eastward, 1e5, 1e5, 1.0)));
  EXPECT_TRUE(ocean_along(ocean, eastward, 1e5, 1e5, 1.0).water.munk_parameters().has_value());
}

}  // namespace
}  // namespace asdic::detail
