#include "raytrace/ocean/slice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/oceans.h"

namespace asdic::detail {
namespace {

/// A ridge under a front and a swell, the sea floor of another kind on each facet.
Environment varied(ShapeInterpolation interpolation) {
  Environment e;
  const std::vector<double> r = {-3000, 0, 2500, 5000, 9000}, z = {0, 100, 300, 1200};
  std::vector<double> c;
  for (const double x : r)
    for (const double depth : z) c.push_back(1480.0 + 1e-3 * x + 0.02 * depth + 1e-6 * x * depth);
  e.section = SoundSpeedSection(r, z, c);
  e.surface.shape = support::swell(interpolation, 81);
  const auto ridge = support::ridge(interpolation, 17);
  std::vector<BoundaryMaterial> floor;
  for (std::size_t i = 0; i < ridge.ranges().size(); ++i)
    floor.emplace_back(FluidHalfSpace{.speed = 1600.0 + 10.0 * double(i)});
  e.bottom.shape = BoundaryShape(ridge.ranges(), ridge.depths(), interpolation, floor);
  return e;
}

double floor_speed(const Environment& e, double range) {
  return std::get<FluidHalfSpace>(e.bottom.material_at(range)).speed;
}

class Slices : public testing::TestWithParam<ShapeInterpolation> {};

// A point of the plane and the point of the transect that it is: depths, materials and speeds are
// the same; a slope along the plane is that along the transect times cos β. Rounding of ranges of
// 10⁵ m moves a point by 10⁻¹¹ m.
TEST_P(Slices, IsTheSameOceanElsewhere) {
  const Environment ocean = varied(GetParam());
  for (const double cosine : {1.0, 0.3, -0.3, -1.0}) {
    const double x0 = 1234.5;
    const Environment plane = slice(ocean, x0, cosine);
    EXPECT_DOUBLE_EQ(plane.bottom.depth, ocean.bottom.depth_at(x0));
    for (double x = -6000.0; x <= 18000.0; x += 173.3) {
      const double r = (x - x0) / cosine;
      EXPECT_NEAR(plane.bottom.depth_at(r), ocean.bottom.depth_at(x), 1e-9);
      EXPECT_NEAR(plane.surface.depth_at(r), ocean.surface.depth_at(x), 1e-9);
      EXPECT_EQ(floor_speed(plane, r), floor_speed(ocean, x)) << x << ' ' << cosine;
      const BoundaryPoint here = plane.bottom.shape->at(r), there = ocean.bottom.shape->at(x);
      EXPECT_NEAR(here.slope, cosine * there.slope, 1e-12);
      const SoundSpeed2D a = sound_speed(plane, r, 250.0), b = sound_speed(ocean, x, 250.0);
      EXPECT_NEAR(a.c, b.c, 1e-9);
      EXPECT_NEAR(a.c_r, cosine * b.c_r, 1e-12);
      EXPECT_NEAR(a.c_z, b.c_z, 1e-12);
      EXPECT_NEAR(a.c_rz, cosine * b.c_rz, 1e-15);
    }
    EXPECT_NEAR(plane.water.at(170.0).c, sound_speed(ocean, x0, 170.0).c, 1e-9);
  }
}

// κ = z″/(1 + z′²)^{3/2}: in the plane z′ is cos β and z″ cos²β times as large.
TEST(Slice, CurvatureFollows) {
  const Environment ocean = varied(ShapeInterpolation::smooth);
  const double cosine = -0.6, x0 = -500.0;
  const Environment plane = slice(ocean, x0, cosine);
  for (double x = -1900.0; x < 14000.0; x += 311.0) {
    const BoundaryPoint there = ocean.bottom.shape->at(x),
                        here = plane.bottom.shape->at((x - x0) / cosine);
    const double second = there.curvature * std::pow(1.0 + there.slope * there.slope, 1.5);
    const double expected = cosine * cosine * second / std::pow(1.0 + here.slope * here.slope, 1.5);
    EXPECT_NEAR(here.curvature, expected, 1e-12);
  }
}

TEST_P(Slices, AlongTheTransectIsTheOceanItself) {
  const Environment ocean = varied(GetParam()), plane = slice(ocean, 0.0, 1.0);
  for (double r = -4000.0; r < 16000.0; r += 97.0) {
    EXPECT_EQ(plane.bottom.depth_at(r), ocean.bottom.depth_at(r));
    EXPECT_EQ(plane.bottom.shape->at(r).curvature, ocean.bottom.shape->at(r).curvature);
    EXPECT_EQ(sound_speed(plane, r, 77.0).c, sound_speed(ocean, r, 77.0).c);
  }
}

// There and back again: the slice of a slice from its far end backwards is the first line reversed.
TEST_P(Slices, ALineAndItsReverseAreOneOcean) {
  const Environment ocean = varied(GetParam());
  const double length = 7000.0, x0 = 300.0, cosine = 0.7;
  const Environment out = slice(ocean, x0, cosine),
                    back = slice(ocean, x0 + length * cosine, -cosine);
  for (double r = 1.0; r < length; r += 53.0) {
    EXPECT_NEAR(out.bottom.depth_at(r), back.bottom.depth_at(length - r), 1e-9);
    EXPECT_NEAR(out.bottom.shape->at(r).slope, -back.bottom.shape->at(length - r).slope, 1e-12);
    EXPECT_NEAR(out.bottom.shape->at(r).curvature, back.bottom.shape->at(length - r).curvature,
                1e-12);
    EXPECT_NEAR(sound_speed(out, r, 120.0).c, sound_speed(back, length - r, 120.0).c, 1e-9);
    EXPECT_EQ(floor_speed(out, r), floor_speed(back, length - r));
  }
}

INSTANTIATE_TEST_SUITE_P(EveryInterpolation, Slices,
                         testing::Values(ShapeInterpolation::piecewise_linear,
                                         ShapeInterpolation::smooth,
                                         ShapeInterpolation::curvilinear),
                         [](const auto& drawn) {
                           std::string text(name(drawn.param));
                           std::erase(text, '-');
                           return text;
                         });

TEST(Slice, AcrossTheTransectIsLayered) {
  const Environment ocean = varied(ShapeInterpolation::smooth);
  for (const double cosine : {0.0, 6e-17, -1e-12}) {
    const Environment plane = slice(ocean, 3210.0, cosine);
    EXPECT_TRUE(is_layered(plane));
    EXPECT_EQ(plane.bottom.depth, ocean.bottom.depth_at(3210.0));
    EXPECT_EQ(plane.surface.depth, ocean.surface.depth_at(3210.0));
    for (double z = 1.0; z < 1200.0; z += 41.0)
      EXPECT_NEAR(sound_speed(plane, 99.0, z).c, sound_speed(ocean, 3210.0, z).c, 1e-9);
  }
}

}  // namespace
}  // namespace asdic::detail
