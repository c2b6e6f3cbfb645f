// Laws of rays whose beams are displaced at reflections: the beam's width is what neighbouring rays
// say, the cycle is that of the waveguide's modes, and paths are the same both ways.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "raytrace/ocean/beam_displacement.h"
#include "raytrace/runs/arrivals_run.h"
#include "raytrace/tracing/ray_tracer.h"
#include "support/oceans.h"

namespace asdic::detail {
namespace {

constexpr double frequency = 300.0;

const FluidHalfSpace sand{.speed = 1700.0, .density = 1800.0, .attenuation_db_per_wavelength = 0.5};
const ElasticHalfSpace basalt{.speed = 3500.0,
                              .shear_speed = 1800.0,
                              .density = 2500.0,
                              .attenuation_db_per_wavelength = 0.0,
                              .shear_attenuation_db_per_wavelength = 0.0};

RayState at_end(const RayTracer& tracer, double depth, double elevation, double range,
                RayTrajectory& work) {
  tracer.trace(0.0, depth, elevation, {.min_range = -1e6, .max_range = range}, work);
  return work.segments.back().end;
}

// As RayTracer.TubeWidthIsQ: |q|·dα is the width of the tube between two rays, over flat and
// sloping, faceted and curved bottoms, under a front and a swell. Next to a critical angle, and
// where one of the rays is carried over a node between facets, the tubes of ±1e-7 and ±2e-7 rad
// differ: there neighbours tell no width. Elsewhere the wider one's error is three times the
// other's, which leaves 1e-5/3 besides what the plain tube has.
TEST(DisplacedRays, TubeWidthIsQ) {
  RayTrajectory work;
  constexpr double d = 1e-7;
  for (const support::CurvedOcean& one : support::curved_oceans())
    for (const BoundaryMaterial& bottom : {BoundaryMaterial{sand}, BoundaryMaterial{basalt}}) {
      Environment ocean = one.environment;
      ocean.bottom.material = bottom;
      const RayTracer tracer(ocean, frequency, Reflection::displaced);
      int compared = 0;
      for (int i = 0; i < 60; ++i) {
        const double elevation = one.lowest + (one.highest - one.lowest) * (i + 0.37) / 60.0;
        const RayState y = at_end(tracer, one.source_depth, elevation, one.range, work);
        if (y.range != one.range) continue;
        const std::size_t segments = work.segments.size(), bounces = work.bounces.size();
        const double cosine = std::abs(y.xi) / std::hypot(y.xi, y.zeta);
        bool together = true;
        const auto width = [&](double step) {
          const auto depth = [&](double angle) {
            const RayState end = at_end(tracer, one.source_depth, angle, one.range, work);
            together &= work.segments.size() == segments && work.bounces.size() == bounces &&
                        end.range == one.range;
            return end.depth;
          };
          return std::abs(depth(elevation + step) - depth(elevation - step)) * cosine /
                 (2.0 * step);
        };
        const double narrow = width(d), wide = width(2.0 * d);
        if (!together || narrow < 50.0 || std::abs(wide / narrow - 1.0) > 1e-5) continue;
        SCOPED_TRACE(testing::Message() << one.name << " at " << elevation);
        EXPECT_NEAR(std::abs(y.q) / narrow, 1.0, std::max(2e-5, one.tolerance)) << narrow;
        ++compared;
      }
      EXPECT_GT(compared, 8) << one.name;
    }
}

/// The number of a mode as a real function of wave number and angular frequency,
/// 2γD − φ − π = 2πm, in isovelocity water of depth D. \param near  a grazing angle close by, whose
/// phase is unwrapped from
double mode_number(const BoundaryMaterial& bottom, double depth, double k, double omega,
                   double near) {
  const auto r = [&](double angle) {
    return reflection_coefficient(bottom, angle, {.speed = 1500.0, .density = 1000.0});
  };
  const double gamma = std::sqrt(omega * omega / (1500.0 * 1500.0) - k * k);
  const double phase = std::arg(r(near)) + std::arg(r(std::atan2(gamma, k)) / r(near));
  return (2.0 * gamma * depth - phase - pi) / (2.0 * pi);
}

// A mode of a Pekeris waveguide and the ray of its angle: the eigenvalue m(k, ω) is exact in
// isovelocity water, and with m fixed the ray's cycle is L = −2π ∂m/∂k long and takes T = 2π ∂m/∂ω,
// so that L/T is the mode's group speed and L = 2π/(k_m − k_{m+1}) in the limit of many modes
// (Tindle & Bold, JASA 70, 813 (1981)). Without displacement the cycle is short by Δ. Differences
// of 1e-6 of k and ω: 1e-8 of L.
TEST(DisplacedRays, CycleIsThatOfTheModes) {
  constexpr double depth = 200.0, omega = 2.0 * pi * frequency;
  for (const BoundaryMaterial& bottom : {BoundaryMaterial{sand}, BoundaryMaterial{basalt}})
    for (const double grazing : {0.05, 0.17, 0.31, 0.42}) {
      const double k = omega * std::cos(grazing) / 1500.0;
      const auto m = [&](double dk, double domega) {
        return mode_number(bottom, depth, k + dk, omega + domega, grazing);
      };
      const double hk = 1e-6 * k, hw = 1e-6 * omega;
      const double length = -pi * (m(hk, 0.0) - m(-hk, 0.0)) / hk;
      const double time = pi * (m(0.0, hw) - m(0.0, -hw)) / hw;

      Environment ocean;
      ocean.water = SoundSpeedProfile::isovelocity(1500.0);
      ocean.water_density = 1000.0;
      ocean.bottom = {.depth = depth, .material = bottom};
      RayTrajectory ray;
      const auto cycle = [&](Reflection reflection) {
        const RayTracer tracer(ocean, frequency, reflection);
        tracer.trace(0.0, 50.0, grazing, {.max_range = 50e3}, ray);
        RayState first, second;  // at the surface, which displaces nothing
        for (const RaySegment& s : ray.segments)
          if (s.end.depth == 0.0) {
            if (s.history.surface_bounces == 0) first = s.end;
            if (s.history.surface_bounces == 1) second = s.end;
          }
        return std::pair(second.range - first.range, second.time - first.time);
      };
      SCOPED_TRACE(testing::Message() << bottom.index() << " at " << grazing);
      const auto [l, t] = cycle(Reflection::displaced);
      EXPECT_NEAR(l, length, 1e-6 * length);
      EXPECT_NEAR(t, time, 1e-6 * time);
      const auto [short_l, short_t] = cycle(Reflection::on_the_spot);
      const double moved =
          beam_displacement(bottom, grazing, {.speed = 1500.0, .density = 1000.0}, frequency)
              .length;
      EXPECT_NEAR(short_l, length - moved, 1e-6 * length);
    }
}

/// Paths over sand, under a thermocline.
Arrivals paths(double source, double receiver, double range) {
  PropagationCase run_case;
  run_case.frequency = frequency;
  run_case.task = Task::arrivals;
  run_case.environment.water = SoundSpeedProfile::table(
      std::vector{0.0, 80.0, 200.0}, std::vector{1512.0, 1500.0, 1495.0}, Interpolation::c_linear);
  run_case.environment.bottom = {.depth = 200.0, .material = sand};
  run_case.beams.displacement = true;
  run_case.source_depths = {source};
  run_case.receivers = {.depths = {receiver}, .ranges = {range}};
  return run_arrivals(run_case).arrivals.at(0);
}

// Source and receiver exchanged: the same paths, whose shifts add up in the other order. A miss of
// 1e-6 m is 1e-9 s.
TEST(DisplacedRays, AreReciprocal) {
  const Arrivals there = paths(50.0, 120.0, 3000.0), back = paths(120.0, 50.0, 3000.0);
  ASSERT_EQ(there.size(), back.size());
  ASSERT_GT(there.size(), 10U);
  for (std::size_t i = 0; i < there.size(); ++i) {
    EXPECT_NEAR(there[i].delay, back[i].delay, 1e-9);
    EXPECT_NEAR(std::abs(there[i].amplitude), std::abs(back[i].amplitude),
                1e-6 * std::abs(back[i].amplitude));
  }
}

// Nothing is counted twice: the phase of a path, arg A − ωτ, falls by ω·ξ per metre of range, the
// slowness at the receiver. The coefficient's phase alone changes with the angle, too; the delay's
// share of the displacement takes that back. Over ±0.1 m the third derivative of the phase leaves
// 1e-6 of k but where the angle is next to critical, and delays of 1e-10 s another 1e-6.
TEST(DisplacedRays, PhaseHasTheSlownessAsItsGradient) {
  constexpr double h = 0.1, omega = 2.0 * pi * frequency;
  const Arrivals near = paths(50.0, 120.0, 3000.0 - h), far = paths(50.0, 120.0, 3000.0 + h);
  ASSERT_EQ(near.size(), far.size());
  int compared = 0, moved = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Arrival &a = near[i], &b = far[i];
    if (a.surface_bounces != b.surface_bounces || a.bottom_bounces != b.bottom_bounces) continue;
    const double coefficient = std::arg(b.amplitude / a.amplitude);
    const double wave_number = (omega * (b.delay - a.delay) - coefficient) / (2.0 * h);
    const double expected = 0.5 * omega * (a.horizontal_slowness + b.horizontal_slowness);
    EXPECT_NEAR(wave_number, expected, 1e-5 * expected) << i;
    ++compared;
    moved += std::abs(coefficient) > 1e-4 * omega * (b.delay - a.delay) ? 1 : 0;
  }
  EXPECT_GT(compared, 10);
  EXPECT_GT(moved, 5);  // for these the test would fail without the delay's share
}

}  // namespace
}  // namespace asdic::detail
