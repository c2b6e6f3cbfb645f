#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/eigenrays.h"
#include "raytrace/ocean/slice.h"

namespace asdic {
namespace {

Environment rough_sea(double height, double floor_db = -300.0) {
  Environment ocean;
  ocean.water = SoundSpeedProfile::isovelocity(1500.0);
  ocean.surface.roughness = {.rms_height = height, .floor_db = floor_db};
  ocean.bottom = {.depth = 200.0, .material = Rigid{}};
  return ocean;
}

TEST(Roughness, OfThePhysicsPage) {
  EXPECT_NEAR(pierson_moskowitz_height(10.0), 0.56, 0.005);
  // 4 kHz, 10 m/s, 10°: 46 dB a bounce.
  const Roughness sea{.rms_height = pierson_moskowitz_height(10.0), .floor_db = -300.0};
  EXPECT_NEAR(db_from_amplitude(
                  coherent_reflection(sea, std::sin(radians(10.0)), 2.0 * pi * 4000.0 / 1500.0)),
              -46.0, 0.5);
  EXPECT_EQ(coherent_reflection({}, 0.5, 10.0), 1.0);
  EXPECT_DOUBLE_EQ(coherent_reflection({.rms_height = 1.0, .floor_db = -20.0}, 1.0, 100.0), 0.1);
}

// Every path against the same in a smooth sea: exp(−G²/2), G = 2kh sin θ, a surface bounce; the
// mirror of the bottom stays. A rough model without the angle, or with half of G, fails.
TEST(Roughness, EveryPathOfBothSolversLosesItsBounces) {
  const double f = 1500.0, h = 0.3, k = 2.0 * pi * f / 1500.0;
  const PathLimits limits{.max_surface_bounces = 3, .max_bottom_bounces = 3};
  Environment smooth = rough_sea(0.0), rough = rough_sea(h);
  for (const bool march : {false, true}) {
    if (march)
      for (Environment* ocean : {&smooth, &rough}) {  // a bottom of two nodes: a shape
        const double range[] = {0.0, 1e5}, depth[] = {200.0, 200.0};
        ocean->bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
      }
    ASSERT_EQ(is_layered(rough), !march);
    const Arrivals before = EigenraySolver(smooth).find(50.0, 100.0, 2000.0, f, limits);
    const Arrivals after = EigenraySolver(rough).find(50.0, 100.0, 2000.0, f, limits);
    ASSERT_EQ(before.size(), after.size());
    int bounced = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
      const double g = 2.0 * k * h * std::sin(std::abs(before[i].launch_elevation));
      const double left = std::exp(-0.5 * g * g * before[i].surface_bounces);
      EXPECT_NEAR(std::abs(after[i].amplitude), std::abs(before[i].amplitude) * left,
                  1e-9 * std::abs(before[i].amplitude));
      bounced += before[i].surface_bounces > 0;
      if (before[i].surface_bounces == 0) {
        EXPECT_EQ(after[i].amplitude, before[i].amplitude);
      }
    }
    EXPECT_GE(bounced, 4);
  }
}

// What is not in the mean field any more goes on along the path: of heights without a law that
// scatters elsewhere |amplitude|² + scattered is the smooth sea's |amplitude|², however rough, of
// both solvers; bubbles take their share of both. A path is heard though its mean field is gone.
TEST(Roughness, WhatIsScatteredGoesOnAlongThePath) {
  const double f = 3500.0;
  const PathLimits limits{.max_surface_bounces = 3, .max_bottom_bounces = 3};
  for (const double height : {0.02, 0.5})
    for (const double wind : {0.0, 10.0})
      for (const bool march : {false, true}) {
        Environment smooth = rough_sea(0.0), rough = rough_sea(height);
        rough.surface.roughness.sea_wind = wind;
        rough.surface.roughness.bubble_wind = wind;
        rough.bottom.roughness.rms_height = 0.5 * height;
        if (march)
          for (Environment* ocean : {&smooth, &rough}) {
            const double range[] = {0.0, 1e5}, depth[] = {200.0, 200.0};
            ocean->bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
          }
        const Arrivals before = EigenraySolver(smooth).find(50.0, 100.0, 2000.0, f, limits);
        const Arrivals after = EigenraySolver(rough).find(50.0, 100.0, 2000.0, f, limits);
        ASSERT_EQ(before.size(), after.size());
        for (std::size_t i = 0; i < after.size(); ++i) {
          double left = std::norm(before[i].amplitude);
          for (const Bounce& bounce : before[i].bounces)
            if (bounce.boundary == BoundaryKind::surface && wind > 0.0)
              left *= power_from_db(-bubble_loss_db(wind, std::sin(bounce.grazing), f));
          EXPECT_NEAR(std::norm(after[i].amplitude) + after[i].scattered, left, 1e-9 * left);
          EXPECT_LE(std::norm(after[i].amplitude), left * (1.0 + 1e-9));
        }
      }
}

TEST(Roughness, ABounceLeavesAtLeastTheFloor) {
  const Arrivals paths = EigenraySolver(rough_sea(5.0, -20.0)).find(50.0, 100.0, 500.0, 4000.0, {});
  for (const Arrival& path : paths)
    EXPECT_NEAR(std::abs(path.reflection), std::pow(0.1, path.surface_bounces), 1e-9);
}

TEST(Roughness, StaysWithASlice) {
  Environment ocean = rough_sea(0.7);
  const double range[] = {0.0, 1e4}, depth[] = {200.0, 300.0};
  ocean.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  ocean.bottom.roughness.rms_height = 0.2;
  for (const double cosine : {0.0, 0.5}) {
    EXPECT_EQ(slice(ocean, 100.0, cosine).surface.roughness.rms_height, 0.7);
    EXPECT_EQ(slice(ocean, 100.0, cosine).bottom.roughness.rms_height, 0.2);
  }
}

}  // namespace
}  // namespace asdic
