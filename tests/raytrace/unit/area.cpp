#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "raytrace/area/ocean_on_map.h"
#include "raytrace/ocean/slice.h"
#include "support/geodesic.h"
#include "support/map_of.h"

namespace asdic::detail {
namespace {

using support::floor_of;
using support::MapOf;

double value_at(const MapAxis& axis, double x, const std::function<double(double)>& f,
                const std::array<double, 4> MapAxis::Cubic::*part) {
  const MapAxis::Cubic c = axis.cubic(x);
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) sum += (c.*part)[i] * f(axis.places()[c.index[i]]);
  return sum;
}

// Slopes at the places are those of parabolas: a parabola is met exactly, on uneven places too.
TEST(MapAxis, AParabolaIsMetExactlyInside) {
  const MapAxis axis("x", {0.0, 1.0, 2.5, 3.0, 7.0, 8.0});
  const auto f = [](double x) { return 2.0 - 3.0 * x + 0.5 * x * x; };
  for (double x = 1.0; x <= 7.0; x += 0.37) {
    EXPECT_NEAR(value_at(axis, x, f, &MapAxis::Cubic::value), f(x), 1e-12) << x;
    EXPECT_NEAR(value_at(axis, x, f, &MapAxis::Cubic::slope), -3.0 + x, 1e-12) << x;
    EXPECT_NEAR(value_at(axis, x, f, &MapAxis::Cubic::bend), 1.0, 1e-11) << x;
  }
}

TEST(MapAxis, ValueAndSlopeAreContinuousAndGoOnLevel) {
  const MapAxis axis("x", {0.0, 1.0, 2.5, 3.0, 7.0, 8.0});
  const auto f = [](double x) { return std::sin(x); };
  for (const double x : axis.places().subspan(1, 4))
    for (const auto part : {&MapAxis::Cubic::value, &MapAxis::Cubic::slope})
      EXPECT_NEAR(value_at(axis, x - 1e-9, f, part), value_at(axis, x + 1e-9, f, part), 1e-7) << x;
  EXPECT_NEAR(value_at(axis, 20.0, f, &MapAxis::Cubic::value), std::sin(8.0), 1e-12);
  EXPECT_EQ(value_at(axis, 20.0, f, &MapAxis::Cubic::slope), 0.0);
}

TEST(MapAxis, PlacesMustIncrease) {
  EXPECT_THROW(MapAxis("x", {0.0, 1.0, 1.0}), InputError);
  EXPECT_THROW(MapAxis("x", {0.0}), InputError);
  EXPECT_THROW(MapAxis("x", {0.0, 1.0, 1.0 + 1e-6, 2.0}), InputError);
}

// The distance from the origin and the bearing there are those of geodesics on the ellipsoid: 1 mm
// at 100 km, 5 cm at 300 km.
TEST(MapFrame, DistanceAndBearingFromTheOriginAreThoseOfGeodesics) {
  for (const double latitude : {1.0, 31.5, -45.0, 70.0}) {
    const GeographicPlace origin{latitude, -65.5};
    const MapFrame frame = MapFrame::geographic(origin);
    for (const double bearing : {0.1, 1.3, 2.9, -2.0})
      for (const double distance : {1.0, 5e3, 1e5, 3e5}) {
        const double x = distance * std::sin(bearing), y = distance * std::cos(bearing);
        const auto place = frame.on_grid(x, y);
        const support::Geodesic way(origin.latitude, origin.longitude, place.v, place.u);
        const double off = 1e-3 * std::max(0.1, std::pow(distance / 1e5, 4.0));
        EXPECT_NEAR(way.distance, distance, off) << latitude << ' ' << bearing;
        EXPECT_NEAR(std::remainder(way.bearing - bearing, 2.0 * pi), 0.0, off / distance);
        const Vec2 back = frame.on_map(place.u, place.v);
        EXPECT_NEAR(back.x(), x, 1e-4);
        EXPECT_NEAR(back.y(), y, 1e-4);
        constexpr double step = 10.0;
        const auto differs = [&](const Vec2& move, double in_u, double in_v) {
          const auto after = frame.on_grid(x + move.x(), y + move.y()),
                     before = frame.on_grid(x - move.x(), y - move.y());
          EXPECT_NEAR(in_u, (after.u - before.u) / (2.0 * step), 1e-10);
          EXPECT_NEAR(in_v, (after.v - before.v) / (2.0 * step), 1e-10);
        };
        differs({step, 0.0}, place.u_x, place.v_x);
        differs({0.0, step}, place.u_y, place.v_y);
      }
  }
}

// A grid of 10⁸ places: what is read is a tile.
TEST(MapGrid, ReadsNoMoreThanItIsAskedFor) {
  const MapOf map(0.0, 1e6, 10'001, 1, [](double x, double y, std::size_t) { return x + 2.0 * y; });
  EXPECT_EQ(*map.read, 0U);
  EXPECT_EQ(*map.grid->at(5000, 7000), static_cast<float>(500'000.0 + 1'400'000.0));
  EXPECT_EQ(*map.grid->at(10'000, 10'000), static_cast<float>(3e6));
  EXPECT_LE(*map.read, 2U * 128U * 128U);
}

double hill(double x, double y) {
  return 1000.0 - 300.0 * std::exp(-((x - 500.0) * (x - 500.0) + 2.0 * y * y) / 4e6);
}

TEST(ScalarMap, DerivativesAreThoseOfItsValues) {
  for (const bool geographic : {false, true}) {
    const MapFrame frame =
        geographic ? MapFrame::geographic({40.0, 10.0}) : MapFrame::projected(0.0, 0.0);
    const MapOf map(geographic ? 9.0 : -1e4, geographic ? 11.0 : 1e4, 81, 1,
                    [&](double u, double v, std::size_t) {
                      if (!geographic) return hill(u, v);
                      const Vec2 place = frame.on_map(u, v + 30.0);
                      return hill(place.x(), place.y());
                    });
    // Latitudes 39 to 41 on an axis of their own.
    std::vector<double> north;
    for (const double v : map.grid->y().places()) north.push_back(geographic ? v + 30.0 : v);
    const auto grid = std::make_shared<const MapGrid>(
        map.grid->x(), MapAxis("y", north), 1,
        [&](const MapGrid::Window& w, std::span<float> values) {
          for (std::size_t j = 0; j < w.rows; ++j)
            for (std::size_t i = 0; i < w.columns; ++i)
              values[j * w.columns + i] = *map.grid->at(w.column + i, w.row + j);
        });
    const ScalarMap floor(grid, frame, MapInterpolation::bicubic, 1.0, {"test"});
    for (const auto& [x, y] : {std::pair{130.0, -77.0}, {2111.0, 1033.0}, {-3333.0, 17.0}}) {
      constexpr double h = 0.5;
      const MapValue at = floor.at(x, y);
      const auto f = [&](double dx, double dy) { return floor.at(x + dx, y + dy); };
      EXPECT_NEAR(at.x, (f(h, 0).value - f(-h, 0).value) / (2 * h), 1e-5);
      EXPECT_NEAR(at.y, (f(0, h).value - f(0, -h).value) / (2 * h), 1e-5);
      EXPECT_NEAR(at.xx, (f(h, 0).x - f(-h, 0).x) / (2 * h), 1e-7);
      EXPECT_NEAR(at.xy, (f(h, 0).y - f(-h, 0).y) / (2 * h), 1e-7);
      EXPECT_NEAR(at.yy, (f(0, h).y - f(0, -h).y) / (2 * h), 1e-7);
    }
  }
}

// A plane is a plane by either rule.
TEST(ScalarMap, APlaneIsMetExactly) {
  for (const auto rule : {MapInterpolation::bicubic, MapInterpolation::faceted}) {
    const ScalarMap floor = floor_of(
        5000.0, 100.0, [](double x, double y) { return 500.0 + 0.25 * x - 0.125 * y; }, rule);
    const MapValue at = floor.at(123.4, -567.8);
    EXPECT_NEAR(at.value, 500.0 + 0.25 * 123.4 + 0.125 * 567.8, 1e-4);
    EXPECT_NEAR(at.x, 0.25, 1e-6);
    EXPECT_NEAR(at.y, -0.125, 1e-6);
  }
}

TEST(ScalarMap, AHoleIsToldByItsPlace) {
  const ScalarMap floor = floor_of(5000.0, 100.0, [](double x, double y) {
    return std::hypot(x - 2000.0, y) < 300.0 ? std::nan("") : 100.0;
  });
  EXPECT_EQ(floor.at(0.0, 0.0).value, 100.0);
  try {
    static_cast<void>(floor.at(2000.0, 0.0));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("test: depth at 2000 m east, 0 m north"));
  }
}

Environment sandy() {
  Environment ocean;
  ocean.bottom = {.depth = 1000.0, .material = FluidHalfSpace{}};
  return ocean;
}

// Of a smooth hill, in planes across and beside it: what is left out between nodes is centimetres.
TEST(AreaSection, FollowsABicubicMap) {
  const Area area({.floor = floor_of(20e3, 250.0, hill)}, sandy());
  for (const double bearing : {0.0, 0.7, 2.0, 4.4}) {
    const Vec2 place(-1500.0, 300.0);
    const Environment plane = area.section(place, bearing, 12e3);
    ASSERT_TRUE(plane.bottom.shape);
    EXPECT_LT(plane.bottom.shape->ranges().size(), 60U);
    for (double r = 0.0; r < 12e3; r += 7.0) {
      const double x = place.x() + r * std::sin(bearing), y = place.y() + r * std::cos(bearing);
      const BoundaryPoint there = plane.bottom.shape->at(r);
      const MapValue floor = area.floor().at(x, y);
      EXPECT_NEAR(there.depth, floor.value, 0.1) << bearing << ' ' << r;
      EXPECT_NEAR(there.slope, floor.x * std::sin(bearing) + floor.y * std::cos(bearing), 4e-3)
          << bearing << ' ' << r;
    }
  }
}

TEST(AreaSection, FollowsAFacetedMapExactly) {
  const Area area({.floor = floor_of(20e3, 250.0, hill, MapInterpolation::faceted)}, sandy());
  const Vec2 place(-1503.0, 311.0);
  for (const double bearing : {0.3, 1.9, 5.0}) {
    const Environment plane = area.section(place, bearing, 9e3);
    for (double r = 0.0; r < 9e3; r += 3.1)
      EXPECT_NEAR(
          plane.bottom.depth_at(r),
          area.bottom_depth(place.x() + r * std::sin(bearing), place.y() + r * std::cos(bearing)),
          2e-3)
          << bearing << ' ' << r;
  }
}

// On axes whose steps grow from 50 to 900 m.
TEST(AreaSection, FollowsAFacetedMapOfUnevenSteps) {
  std::vector<double> places{-3000.0};
  for (double step = 50.0; step < 1000.0; step *= 1.35) places.push_back(places.back() + step);
  const auto grid = std::make_shared<const MapGrid>(
      MapAxis("x", places), MapAxis("y", places), 1,
      [places](const MapGrid::Window& window, std::span<float> values) {
        std::size_t next = 0;
        for (std::size_t j = 0; j < window.rows; ++j)
          for (std::size_t i = 0; i < window.columns; ++i)
            values[next++] =
                static_cast<float>(hill(places[window.column + i], places[window.row + j]));
      });
  const Area area({.floor = ScalarMap(grid, MapFrame::projected(0.0, 0.0),
                                      MapInterpolation::faceted, 1.0, {"test: depth"})},
                  sandy());
  const Vec2 place(-2903.0, -2811.0);
  for (const double bearing : {0.3, 0.8, 1.4}) {
    const Environment plane = area.section(place, bearing, 4e3);
    for (double r = 0.0; r < 2600.0; r += 1.7)
      ASSERT_NEAR(
          plane.bottom.depth_at(r),
          area.bottom_depth(place.x() + r * std::sin(bearing), place.y() + r * std::cos(bearing)),
          2e-3)
          << bearing << ' ' << r;
  }
}

// A map of a transect, in any plane: today's slice of that transect.
TEST(AreaSection, ASlopeIsTheTransects) {
  const Transect transect{.x = 100.0, .y = -50.0, .bearing = radians(30.0)};
  Environment along = sandy();
  along.bottom.shape = BoundaryShape(std::vector{-2e4, 2e4}, std::vector{1500.0, 500.0},
                                     ShapeInterpolation::piecewise_linear);
  const Area area({.floor = floor_of(15e3, 250.0,
                                     [&](double x, double y) {
                                       return along.bottom.depth_at(transect.range_of(x, y));
                                     })},
                  sandy());
  for (const double bearing : {radians(30.0), radians(75.0), radians(200.0)}) {
    const Vec2 place(400.0, 900.0);
    const Environment plane = area.section(place, bearing, 8e3);
    const Environment slice_of =
        slice(along, transect.range_of(place.x(), place.y()), std::cos(bearing - transect.bearing));
    for (double r = 0.0; r < 8e3; r += 100.0) {
      EXPECT_NEAR(plane.bottom.depth_at(r), slice_of.bottom.depth_at(r), 1e-3);
      EXPECT_NEAR(plane.bottom.shape->at(r).slope, slice_of.bottom.shape->at(r).slope, 1e-6);
    }
  }
}

TEST(AreaSection, AFlatMapIsALayeredOcean) {
  const Area area({.floor = floor_of(15e3, 250.0, [](double, double) { return 800.0; })}, sandy());
  const Environment plane = area.section({10.0, 20.0}, 1.0, 5e3);
  EXPECT_TRUE(is_layered(plane));
  EXPECT_NEAR(plane.bottom.depth, 800.0, 1e-9);
}

// Sand west of x = 1000 m, mud east of it; land from 4 km on.
TEST(AreaSection, KindsOfSeaFloorChangeWhereTheMapSaysAndLandEndsIt) {
  const auto depth = [](double x, double) { return 400.0 - 0.1 * x; };
  const MapOf kinds(-10e3, 10e3, 201, 1,
                    [](double x, double, std::size_t) { return x < 1000.0 ? 1.0 : 7.0; });
  const FluidHalfSpace sand{.speed = 1700.0}, mud{.speed = 1480.0};
  const Area area({.floor = floor_of(10e3, 100.0, depth),
                   .seabed = ClassMap(kinds.grid, MapFrame::projected(0.0, 0.0), {"kinds"}),
                   .materials = {{1, sand}, {7, mud}}},
                  sandy());
  const Environment plane = area.section({0.0, 0.0}, radians(90.0), 8e3);
  const auto at = [&](double r) { return plane.bottom.material_at(r); };
  EXPECT_EQ(at(500.0), BoundaryMaterial(sand));
  EXPECT_EQ(at(940.0), BoundaryMaterial(sand));  // half a cell before the first place of mud
  EXPECT_EQ(at(960.0), BoundaryMaterial(mud));
  EXPECT_EQ(at(3900.0), BoundaryMaterial(mud));
  EXPECT_EQ(std::abs(reflection_coefficient(at(4100.0), 0.3, {})), 0.0);
  EXPECT_NEAR(plane.bottom.depth_at(3990.0), 1.0, 0.1);
  EXPECT_NEAR(plane.bottom.depth_at(6000.0), 0.1, 1e-9);
  const Area missing({.floor = floor_of(10e3, 100.0, depth),
                      .seabed = ClassMap(kinds.grid, MapFrame::projected(0.0, 0.0), {"kinds"}),
                      .materials = {{1, sand}}},
                     sandy());
  EXPECT_THROW(static_cast<void>(missing.section({0.0, 0.0}, radians(90.0), 8e3)), InputError);
}

double front(double x, double y, double z) {
  return 1480.0 + 20.0 * std::exp(-z / 100.0) * (1.0 + 0.3 * std::tanh((x + 0.4 * y) / 8e3)) +
         0.016 * z;
}

TEST(WaterMap, DerivativesAreThoseOfItsValues) {
  const std::vector<double> levels{0.0, 10.0, 25.0, 50.0, 100.0, 200.0, 400.0, 700.0, 1000.0};
  const MapOf map(-20e3, 20e3, 41, levels.size(),
                  [&](double x, double y, std::size_t k) { return front(x, y, levels[k]); });
  const WaterMap water(map.grid, MapFrame::projected(0.0, 0.0), levels, {"test"});
  const Vec3 place(1234.0, -777.0, 61.0);
  const SoundSpeed3D c = water.at(place.x(), place.y(), place.z());
  EXPECT_NEAR(c.c, front(place.x(), place.y(), place.z()), 0.1);
  const auto f = [&](int axis, double h) {
    Vec3 there = place;
    there[axis] += h;
    return water.at(there.x(), there.y(), there.z());
  };
  constexpr double h = 5.0;
  EXPECT_NEAR(c.c_x, (f(0, h).c - f(0, -h).c) / (2 * h), 1e-7);
  EXPECT_NEAR(c.c_y, (f(1, h).c - f(1, -h).c) / (2 * h), 1e-7);
  EXPECT_NEAR(c.c_z, (f(2, 0.5).c - f(2, -0.5).c), 1e-5);
  EXPECT_NEAR(c.c_xx, (f(0, h).c_x - f(0, -h).c_x) / (2 * h), 1e-9);
  EXPECT_NEAR(c.c_xy, (f(1, h).c_x - f(1, -h).c_x) / (2 * h), 1e-9);
  EXPECT_NEAR(c.c_xz, (f(2, h).c_x - f(2, -h).c_x) / (2 * h), 1e-8);
  EXPECT_NEAR(c.c_yz, (f(2, h).c_y - f(2, -h).c_y) / (2 * h), 1e-8);
  EXPECT_NEAR(c.c_zz, (f(2, h).c_z - f(2, -h).c_z) / (2 * h), 1e-6);
}

// Straight lines of a section leave the volume by a few hundredths of a metre per second.
TEST(AreaSection, WaterIsThatOfTheVolume) {
  const std::vector<double> levels{0.0, 10.0, 25.0, 50.0, 100.0, 200.0, 400.0, 700.0, 1000.0};
  const MapOf map(-20e3, 20e3, 41, levels.size(),
                  [&](double x, double y, std::size_t k) { return front(x, y, levels[k]); });
  const WaterMap water(map.grid, MapFrame::projected(0.0, 0.0), levels, {"test"});
  const Area area({.floor = floor_of(20e3, 250.0, hill), .water = water}, sandy());
  const Vec2 place(-6000.0, 500.0);
  const double bearing = 1.2;
  const Environment plane = area.section(place, bearing, 12e3);
  ASSERT_TRUE(plane.section);
  for (double r = 0.0; r < 12e3; r += 430.0)
    for (const double z : {0.0, 7.0, 33.0, 80.0, 150.0, 333.0, 900.0}) {
      const double x = place.x() + r * std::sin(bearing), y = place.y() + r * std::cos(bearing);
      EXPECT_NEAR(sound_speed(plane, r, z).c, area.speed_at(x, y, z).c, 0.08) << r << ' ' << z;
    }
}

// Water on a grid of 92 km, so that half a step about two places is 46 km. In every plane the floor
// is that of its own map, and each map ends at its own edge.
TEST(AreaSection, CoarseWaterDoesNotCutTheFloor) {
  const MapOf coarse(-46e3, 46e3, 2, 2,
                     [](double, double, std::size_t k) { return k == 0 ? 1510.0 : 1500.0; });
  const WaterMap water(coarse.grid, MapFrame::projected(0.0, 0.0), {0.0, 3000.0}, {"coarse"});
  const auto ridge = [](double x, double y) {
    return 3000.0 - 3050.0 * std::exp(-std::pow((std::hypot(x, y) - 11e3) / 1500.0, 2.0));
  };
  const ScalarMap floor = floor_of(120e3, 500.0, ridge);
  const Area alone({.floor = floor}, sandy()), both({.floor = floor, .water = water}, sandy());
  const Vec2 place(30.0, -20.0);
  for (const double bearing : {0.0, 1.2, 3.3}) {
    const Environment one = alone.section(place, bearing, 100e3),
                      other = both.section(place, bearing, 100e3);
    for (double r = 0.0; r < 100e3; r += 250.0)
      ASSERT_EQ(one.bottom.depth_at(r), other.bottom.depth_at(r)) << bearing << ' ' << r;
    EXPECT_LT(other.bottom.depth_at(11e3), 1.0);  // land
  }
  // Edges lie half a step beyond the outer places: at 92 km for the water, at 120.25 km for the
  // floor.
  EXPECT_NEAR(both.reach_on_map({0.0, 0.0}, 0.5 * pi, 500e3), 92e3, 2e-3);
  EXPECT_NEAR(alone.reach_on_map({0.0, 0.0}, 0.5 * pi, 500e3), 120.25e3, 2e-3);
  EXPECT_EQ(both.reach_on_map({0.0, 0.0}, 0.5 * pi, 50e3), 50e3);
  const Area::Edge edge = both.nearest_edge({0.0, 0.0}, 500e3);
  EXPECT_NEAR(edge.distance, 92e3, 2e-3);
  EXPECT_EQ(edge.map, "coarse");
}

}  // namespace
}  // namespace asdic::detail
