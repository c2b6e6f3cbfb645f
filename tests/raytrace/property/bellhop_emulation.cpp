#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "raytrace/beams/fan.h"
#include "raytrace/bellhop_emulation/bellhop_emulation.h"
#include "raytrace/propagation.h"
#include "raytrace/runs/field_run.h"
#include "raytrace/runs/rays_run.h"

// Laws of the literal run: what it must keep however BELLHOP does it.

namespace asdic::detail {
namespace {

/// A deep channel over sand, 20 km long.
PropagationCase channel() {
  const double depth[] = {0.0, 300.0, 900.0, 2000.0, 4000.0};
  const double speed[] = {1525.0, 1510.0, 1492.0, 1500.0, 1530.0};
  PropagationCase c;
  c.frequency = 150.0;
  c.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  c.environment.bottom = {.depth = 4000.0, .material = FluidHalfSpace{}};
  c.source_depths = {700.0};
  for (int i = 0; i <= 20; ++i) c.receivers.depths.push_back(100.0 + 190.0 * i);
  for (int i = 1; i <= 40; ++i) c.receivers.ranges.push_back(500.0 * i);
  c.beams.lowest = radians(-30.0);
  c.beams.highest = radians(30.0);
  c.literal = {.step = 200.0, .beams = 801};
  c.box_range = 21e3;
  c.box_depth = 4500.0;
  return c;
}

/// Uniform water without boundaries near.
PropagationCase open_water(BeamKind kind) {
  PropagationCase c;
  c.frequency = 1000.0;
  const double depth[] = {0.0, 10e3}, speed[] = {1500.0, 1500.0};
  c.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  c.environment.bottom = {.depth = 10e3, .material = Vacuum{}};
  c.source_depths = {5000.0};
  c.receivers = {.depths = {4900.0, 5000.0, 5150.0},
                 .ranges = {100.0, 400.0, 700.0, 1000.0, 1300.0}};
  c.beams.kind = kind;
  c.beams.lowest = radians(-40.0);
  c.beams.highest = radians(40.0);
  c.beams.cerveny = CervenyBeams{};
  c.literal = {.step = 50.0, .beams = 2001};
  c.box_range = 2000.0;
  c.box_depth = 10e3;
  return c;
}

TEST(BellhopEmulation, BitsDoNotDependOnThreads) {
  PropagationCase c = channel();
  for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian, BeamKind::ray_centred_hat}) {
    c.beams.kind = kind;
    std::vector<std::complex<float>> alone;
    {
      const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
      alone = run_bellhop_emulation(c).field;
    }
    EXPECT_EQ(run_bellhop_emulation(c).field, alone);
  }
}

// p = Σ A·exp(−iωτ): the arrivals, unmerged and in double precision, are the terms of the field.
// 1e-6: the result is stored in float32.
TEST(BellhopEmulation, FieldIsTheSumOfItsArrivals) {
  PropagationCase c = channel();
  const BellhopEmulationOptions options{.merge = false, .single_precision = false};
  const auto field = run_bellhop_emulation(c, options).field;
  c.task = Task::arrivals;
  const auto arrivals = run_bellhop_emulation(c, options).arrivals;
  ASSERT_EQ(field.size(), arrivals.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    std::complex<double> sum = 0.0;
    double magnitudes = 0.0;
    for (const Arrival& a : arrivals[i]) {
      sum += a.amplitude * std::polar(1.0, -2.0 * pi * c.frequency * a.delay);
      magnitudes += std::abs(a.amplitude);
    }
    EXPECT_NEAR(std::abs(sum - std::complex<double>(field[i])), 0.0, 1e-6 * magnitudes);
  }
}

struct FreeSpace {
  BeamKind kind;
  double level_db, phase;  ///< how near to exp(−ikR)/R, or to what Gaussian beams make of it
  bool gaussian = false;
};

class BellhopEmulationOpenWater : public ::testing::TestWithParam<FreeSpace> {};

// exp(−ikR)/R, and for Gaussian beams, whose fronts are plane,
//   ∫ exp(−(Rα)²/2σ² + ikRα²/2) R dα/(σ√2π) = 1/√(1 − ikσ²/R)
// of it, σ = πλ their least width. Hat beams interpolate linearly between rays: a part in 10⁴ in
// level, k·(R·dα)²/8R of phase. Along a normal the delay lacks nothing here; over a hat's width it
// does, of the same order. Červený's are paraxial: k·n⁴/8R³ at the edge of a beam of half-width 40
// m. Simple Gaussian beams are a quarter of a turn ahead and count a step too many: √(1/R) and
// their widths as at R + step, √(1 + step/R) in all. The first and the last range are left out:
// BELLHOP leaves the first out of beams along normals, both out of its Cartesian Červený beams.
TEST_P(BellhopEmulationOpenWater, IsASphericalWave) {
  const PropagationCase c = open_water(GetParam().kind);
  const auto field = run_bellhop_emulation(c).field;
  const double k = 2.0 * pi * c.frequency / 1500.0;
  for (std::size_t row = 0; row < c.receivers.depths.size(); ++row)
    for (std::size_t column = 1; column + 1 < c.receivers.ranges.size(); ++column) {
      const double distance =
          std::hypot(c.receivers.ranges[column], c.receivers.depths[row] - c.source_depths[0]);
      const std::complex<double> p(field[row * c.receivers.ranges.size() + column]);
      const double sigma = pi * 2.0 * pi / k;
      const std::complex<double> expected =
          GetParam().gaussian
              ? 1.0 / std::sqrt(std::complex<double>(1.0, -k * sigma * sigma / distance))
          : c.beams.kind == BeamKind::simple_gaussian
              ? std::complex<double>(0.0, std::sqrt(1.0 + c.literal.step / distance))
              : 1.0;
      const std::complex<double> ratio = p * distance * std::polar(1.0, k * distance) / expected;
      EXPECT_NEAR(db_from_amplitude(std::abs(ratio)), 0.0, GetParam().level_db)
          << row << ' ' << column;
      EXPECT_NEAR(std::arg(ratio), 0.0, GetParam().phase) << row << ' ' << column;
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, BellhopEmulationOpenWater,
                         ::testing::Values(FreeSpace{BeamKind::hat, 0.01, 0.01},
                                           FreeSpace{BeamKind::gaussian, 0.01, 0.01, true},
                                           FreeSpace{BeamKind::ray_centred_hat, 0.01, 0.01},
                                           FreeSpace{BeamKind::ray_centred_gaussian, 0.01, 0.01,
                                                     true},
                                           FreeSpace{BeamKind::simple_gaussian, 0.01, 0.01},
                                           FreeSpace{BeamKind::cerveny_cartesian, 0.1, 0.05},
                                           FreeSpace{BeamKind::cerveny_ray_centred, 0.1, 0.05}));

// Components of Červený beams: the velocity of a spherical wave, times ρc, is p·dz/R and p·r/R; the
// near field, 1/kR, is 6e-4 at most.
TEST(BellhopEmulation, CervenyComponentsAreTheVelocity) {
  using Component = CervenyBeams::Component;
  for (const BeamKind kind : {BeamKind::cerveny_cartesian, BeamKind::cerveny_ray_centred}) {
    PropagationCase c = open_water(kind);
    const auto pressure = run_bellhop_emulation(c).field;
    for (const Component component : {Component::vertical, Component::horizontal}) {
      c.beams.cerveny->component = component;
      const auto velocity = run_bellhop_emulation(c).field;
      for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 1; column < 4;
             ++column) {  // BELLHOP leaves the first, the last out
          const double r = c.receivers.ranges[column];
          const double dz = c.receivers.depths[row] - c.source_depths[0];
          const double share = (component == Component::vertical ? dz : r) / std::hypot(r, dz);
          const std::size_t i = row * c.receivers.ranges.size() + column;
          const auto ratio = std::complex<double>(velocity[i]) / std::complex<double>(pressure[i]);
          EXPECT_NEAR(std::abs(ratio - share), 0.0, 1e-3) << r << ' ' << dz;
        }
    }
  }
}

// Displaced beams: no output of BELLHOP's is at hand, so the literal run is held to asdic's own
// rays over a slope in isovelocity water, where its steps are exact: the same ends within rounding,
// and with the same hats the same field where rays are spread alike. Cells beside the bottom
// differ: there BELLHOP's beams have a segment along it.
TEST(BellhopEmulation, DisplacedRaysAreOurOwn) {
  PropagationCase c = channel();
  const double depth[] = {0.0, 300.0}, speed[] = {1500.0, 1500.0};
  c.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  c.environment.water_density = 1000.0;  // BELLHOP's
  c.environment.bottom = {
      .depth = 300.0,
      .material =
          FluidHalfSpace{.speed = 1700.0, .density = 1800.0, .attenuation_db_per_wavelength = 0.0},
      .shape = BoundaryShape(std::vector{-1e3, 10e3}, std::vector{300.0, 200.0},
                             ShapeInterpolation::piecewise_linear)};
  c.environment.spreading = Spreading::cylindrical;  // BELLHOP's
  c.source_depths = {100.0};
  c.beams.displacement = true;
  c.box_range = 6e3;
  c.box_depth = 400.0;

  c.task = Task::rays;
  c.literal = {.step = 10.0, .beams = 8};
  c.beams.count = 8;
  const auto rays = run_bellhop_emulation(c).rays.at(0), own_rays = run_rays(c).rays.at(0);
  ASSERT_EQ(rays.size(), own_rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayPath &a = rays[rays.size() - 1 - i], &b = own_rays[i];  // fans run opposite ways
    EXPECT_EQ(a.bottom_bounces, b.bottom_bounces);
    EXPECT_NEAR(a.points.back().depth, b.points.back().depth, 1e-4);
    EXPECT_NEAR(a.points.back().time, b.points.back().time, 1e-8);
  }

  c.task = Task::field;
  c.literal.beams = 4001;
  c.beams.elevations = even_fan(radians(-30.0), radians(30.0), 4001).elevation;
  c.receivers.depths = {50.0, 90.0, 130.0};
  c.receivers.ranges.clear();
  for (int i = 1; i <= 100; ++i) c.receivers.ranges.push_back(55.0 * i);
  const auto field = run_bellhop_emulation(c).field, own = run_field(c).field;
  std::vector<double> errors;
  for (std::size_t i = 0; i < field.size(); ++i)
    errors.push_back(
        std::abs(20.0 * std::log10(double(std::abs(field[i])) / double(std::abs(own[i])))));
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 1e-3);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.1);
}

}  // namespace
}  // namespace asdic::detail
