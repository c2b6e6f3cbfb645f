#include "raytrace/area/earth_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "support/geodesic.h"

namespace asdic::detail {
namespace {

OceanOrigin origin_at(double latitude_deg, double longitude_deg) {
  return {.latitude = radians(latitude_deg), .longitude = radians(longitude_deg)};
}

// The map is azimuthal equidistant about its [0, 0]: distance and bearing from there are x and y's.
// So those of the geodesic: 1 mm at 100 km, the fourth power of the distance beyond.
TEST(EarthPlaces, AreAtTheirDistanceAndBearingFromTheOrigin) {
  for (const auto& [latitude, longitude] :
       {std::pair{0.0, 0.0}, {31.0, -60.5}, {-52.0, 179.95}, {78.0, -179.99}, {60.0, 359.0}}) {
    const EarthPlaces earth(origin_at(latitude, longitude), nullptr);
    ASSERT_TRUE(earth.known());
    for (const double distance : {1.0, 3000.0, 80e3, 300e3})
      for (double bearing = -170.0; bearing < 180.0; bearing += 35.0) {
        const GeographicPlace there =
            earth.at(distance * std::sin(radians(bearing)), distance * std::cos(radians(bearing)));
        const support::Geodesic way(latitude, longitude, there.latitude, there.longitude);
        EXPECT_NEAR(way.distance, distance, 1e-3 * std::max(1.0, std::pow(distance / 1e5, 4.0)));
        EXPECT_NEAR(std::remainder(degrees(way.bearing) - bearing, 360.0), 0.0,
                    distance > 10.0 ? 5e-6 : 1e-3);
      }
  }
  const GeographicPlace itself = EarthPlaces(origin_at(31.0, -60.5), nullptr).at(0.0, 0.0);
  EXPECT_NEAR(itself.latitude, 31.0, 1e-12);
  EXPECT_NEAR(itself.longitude, -60.5, 1e-12);
}

TEST(EarthPlaces, AreNotKnownWithoutAnOriginOrAPlace) {
  EXPECT_FALSE(EarthPlaces().known());
  EXPECT_FALSE(EarthPlaces(std::nullopt, nullptr).known());
  EXPECT_TRUE(std::isnan(EarthPlaces().at(0.0, 0.0).latitude));
  const GeographicPlace nowhere =
      EarthPlaces(origin_at(31.0, -60.5), nullptr).at(std::nan(""), 0.0);
  EXPECT_TRUE(std::isnan(nowhere.latitude) && std::isnan(nowhere.longitude));
}

}  // namespace
}  // namespace asdic::detail
