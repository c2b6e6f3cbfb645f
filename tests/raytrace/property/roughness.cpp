#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/ocean/slice.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/propagation.h"

namespace asdic::detail {
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
// both solvers; bubbles take their share of both. A path is received though its mean field is gone.
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

/// A source at 60 m of a guide of 200 m, receivers along two depths.
PropagationCase guide_of(const Environment& ocean, FieldKind field, double frequency) {
  PropagationCase c;
  c.frequency = frequency;
  c.environment = ocean;
  c.field = field;
  c.source_depths = {60.0};
  c.receivers = {.depths = {30.0, 120.0}, .ranges = {500.0, 1000.0, 2000.0, 4000.0}};
  c.beams.lowest = -radians(60.0);
  c.beams.highest = radians(60.0);
  return c;
}

/// 20 lg of the ratio of two fields, receiver by receiver: the largest.
double largest_difference(const PropagationCase& a, const PropagationCase& b) {
  const PropagationResult x = run(a), y = run(b);
  double worst = 0.0;
  for (std::size_t i = 0; i < x.field.size(); ++i)
    worst = std::max(
        worst, std::abs(db_from_amplitude(double(std::abs(x.field[i]) / std::abs(y.field[i])))));
  return worst;
}

// Without a law that takes energy elsewhere and without bubbles a rough sea loses nothing: the
// field of intensities is the smooth sea's, by images, by every kind of beam, beside the shore and
// on the bottom. The mean field alone would be 10 dB less at 4 km.
TEST(Roughness, IntensitiesKeepWhatIsScattered) {
  for (const bool images : {true, false})
    for (const BeamKind kind :
         {BeamKind::hat, BeamKind::gaussian, BeamKind::ray_centred_hat, BeamKind::simple_gaussian,
          BeamKind::cerveny_cartesian, BeamKind::cerveny_ray_centred}) {
      if (images && kind != BeamKind::hat) continue;
      Environment smooth = rough_sea(0.0), rough = rough_sea(0.5);
      rough.surface.roughness.sea_wind = 10.0;
      rough.bottom.roughness.rms_height = 0.2;
      for (Environment* ocean : {&smooth, &rough}) {
        ocean->bottom.material = FluidHalfSpace{};
        if (images) continue;
        const double depth[] = {0.0, 200.0}, speed[] = {1500.0, 1490.0};
        ocean->water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
      }
      PropagationCase a = guide_of(smooth, FieldKind::incoherent, 1000.0),
                      b = guide_of(rough, FieldKind::incoherent, 1000.0);
      for (PropagationCase* c : {&a, &b}) {
        c->receivers.depths.push_back(200.0);
        c->beams.kind = kind;
        if (!images)  // the same beams in both
          for (int i = -300; i <= 300; ++i) c->beams.elevations.push_back(radians(0.2 * i));
      }
      EXPECT_LT(largest_difference(b, a), 1e-4) << images << ' ' << int(kind);
      a.field = b.field = FieldKind::coherent;
      if (images) {
        EXPECT_GT(largest_difference(b, a), 3.0);
      }
    }
}

// Where a law takes S elsewhere and bubbles their share, images and beams hold the plain sum of
// what E^n leaves of each image, E = max(e^{−G²}, 1 − S)·B off the surface. A rigid floor.
TEST(Roughness, IntensitiesLoseWhatIsAbsorbedAndScatteredElsewhere) {
  const double f = 1000.0, wind = 12.0, share = 0.2, k = 2.0 * pi * f / 1500.0, h = 0.3;
  Environment ocean = rough_sea(h);
  ocean.surface.roughness.bubble_wind = wind;
  ocean.surface.roughness.elsewhere = {.wavenumbers = {k}, .share = {share, share}, .angles = 2};
  PropagationCase c = guide_of(ocean, FieldKind::incoherent, f);
  const auto image = [&](double range, double rise, int bounces) {
    const double length = std::hypot(range, rise), sine = std::abs(rise) / length;
    if (sine > std::sin(radians(60.0))) return 0.0;
    const double g = 2.0 * k * h * sine;
    const double left =
        std::max(std::exp(-g * g), 1.0 - share) * power_from_db(-bubble_loss_db(wind, sine, f));
    return std::pow(left, bounces) / (length * length);
  };
  const auto plain = [&](double range, double depth) {
    const double same = depth - 60.0, mirrored = -depth - 60.0;
    double sum = image(range, same, 0) + image(range, mirrored, 1);
    for (int n = 1; n < 400; ++n) {
      const double up = 400.0 * n;
      sum += image(range, same - up, n) + image(range, mirrored - up, n + 1) +
             image(range, same + up, n) + image(range, mirrored + up, n - 1);
    }
    return sum;
  };
  const PropagationResult images = run(c);
  const double range[] = {0.0, 1e5}, depth[] = {200.0, 200.0};
  c.environment.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  const PropagationResult beams = run(c);
  EXPECT_GT(beams.beams, 2U);
  for (std::size_t i = 0; i < images.field.size(); ++i) {
    const double truth = plain(c.receivers.ranges[i % 4], c.receivers.depths[i / 4]);
    EXPECT_NEAR(db_from_power(std::norm(std::complex<double>(images.field[i])) / truth), 0.0, 1e-3);
    EXPECT_NEAR(db_from_power(std::norm(std::complex<double>(beams.field[i])) / truth), 0.0, 0.3);
  }
}

// One bounce of a mean field m and energy E under a shallow source: far away the mean over heights
// of the pair is 1 + E − 2m cos 2φ, φ = k z_s sin α; a semi-coherent field has it whatever m.
TEST(Roughness, SemiCoherentFieldsHaveThePairsMean) {
  const double f = 300.0, h = 0.6, k = 2.0 * pi * f / 1500.0, zs = 4.0;
  Environment ocean = rough_sea(h);
  ocean.bottom = {.depth = 3000.0, .material = FluidHalfSpace{.speed = 1500.0, .density = 1000.0}};
  ocean.water_density = 1000.0;
  PropagationCase c = guide_of(ocean, FieldKind::semi_coherent, f);
  c.source_depths = {zs};
  c.receivers = {.depths = {400.0, 700.0}, .ranges = {1000.0, 2000.0}};
  const PropagationResult result = run(c);
  for (std::size_t i = 0; i < 4; ++i) {
    const double range = c.receivers.ranges[i % 2], depth = c.receivers.depths[i / 2];
    const double sine = depth / std::hypot(range, depth), g = 2.0 * k * h * sine;
    const double m = std::exp(-0.5 * g * g);
    const double truth =
        (2.0 - 2.0 * m * std::cos(2.0 * k * zs * sine)) / (range * range + depth * depth);
    EXPECT_NEAR(db_from_power(std::norm(std::complex<double>(result.field[i])) / truth), 0.0, 0.1);
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
}  // namespace asdic::detail
