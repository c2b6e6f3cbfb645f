// Laws that hold for every ray that is marched: it agrees with an independent integrator where that
// applies, and its beam's width is what neighbouring rays say it is.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/tracing/ray_tracer.h"
#include "support/integrator.h"
#include "support/oceans.h"

namespace asdic::detail {
namespace {

using support::CurvedOcean;

RayState at_end(const RayTracer& tracer, double depth, double elevation, double range,
                RayTrajectory& work) {
  tracer.trace(0.0, depth, elevation, {.min_range = -1e6, .max_range = range}, work);
  return work.segments.back().end;
}

struct LayeredCase {
  const char* name;
  SoundSpeedProfile water;
};

std::vector<LayeredCase> layered_cases() {
  const std::vector<double> z = {0, 40, 100, 250, 600, 1000, 1600, 2500, 5000};
  const std::vector<double> c = {1522, 1523, 1514, 1503, 1492, 1488, 1490, 1501, 1543};
  return {{"c-linear", SoundSpeedProfile::table(z, c, Interpolation::c_linear)},
          {"n2-linear", SoundSpeedProfile::table(z, c, Interpolation::n2_linear)},
          {"pchip", SoundSpeedProfile::table(z, c, Interpolation::pchip)},
          {"spline", SoundSpeedProfile::table(z, c, Interpolation::spline)},
          {"munk", SoundSpeedProfile::munk()},
          {"isovelocity", SoundSpeedProfile::isovelocity(1500.0)}};
}

// The integrator's own tolerance is 1e-13 a step. The marching of closed forms is exact to
// rounding: over some 200 segments of 50 km, 1e-8 m. The general law accepts 1e-7 m a step, some
// 500 steps.
TEST(RayTracer, AgreesWithAnIndependentIntegratorInLayeredOceans) {
  RayTrajectory work;
  for (const LayeredCase& one : layered_cases()) {
    Environment ocean;
    ocean.water = one.water;
    ocean.bottom.depth = 5000.0;
    const RayTracer tracer(ocean, 1000.0);
    support::RayIntegrator integrator(ocean.water, 0.0, 5000.0);
    const bool closed =
        one.water.depths().size() == 1 ||
        (!one.water.munk_parameters() && (one.water.interpolation() == Interpolation::c_linear ||
                                          one.water.interpolation() == Interpolation::n2_linear));
    const double metres = closed ? 2e-6 : 2e-3;
    for (const double source : {10.0, 600.0, 1234.5, 4990.0})
      for (const double elevation : {-0.9, -0.21, -0.032, 0.013, 0.117, 0.4, 1.2}) {
        SCOPED_TRACE(testing::Message() << one.name << " from " << source << " at " << elevation);
        const RayState y = at_end(tracer, source, elevation, 50e3, work);
        const support::RayPoint truth = integrator.trace(source, elevation, 50e3);
        EXPECT_NEAR(y.depth, truth.depth, metres);
        EXPECT_NEAR(y.time, truth.time, metres / 1500.0);
        EXPECT_NEAR(y.length, truth.path, metres);
        EXPECT_NEAR(std::abs(y.q), std::abs(truth.q),
                    1e-6 * (1e4 + std::abs(truth.q)) * (closed ? 1e-2 : 1.0));
        EXPECT_EQ(work.segments.back().history.surface_bounces, truth.surface_bounces);
        EXPECT_EQ(work.segments.back().history.bottom_bounces, truth.bottom_bounces);
        EXPECT_EQ(work.segments.back().history.caustics +
                      (work.segments.back().begin.q * y.q < 0.0 ? 1 : 0),
                  truth.caustics);
      }
  }
}

// The width of the tube between two rays launched dα apart, measured across the ray between them,
// is |q|·dα + O(dα³). With dα = 2e-6 the third-order term is below 1e-9 of a smooth tube, and
// positions of 1e-8 m over a tube of some 0.1 m leave 1e-6.
TEST(RayTracer, TubeWidthIsQ) {
  RayTrajectory work;
  constexpr double d = 1e-6;
  for (const CurvedOcean& one : support::curved_oceans()) {
    const RayTracer tracer(one.environment, 1000.0);
    int compared = 0;
    for (int i = 0; i < 60; ++i) {
      const double elevation = one.lowest + (one.highest - one.lowest) * (i + 0.37) / 60.0;
      const RayState low = at_end(tracer, one.source_depth, elevation - d, one.range, work);
      const std::size_t segments = work.segments.size(), bounces = work.bounces.size();
      const RayState high = at_end(tracer, one.source_depth, elevation + d, one.range, work);
      if (work.segments.size() != segments || work.bounces.size() != bounces) continue;
      const RayState y = at_end(tracer, one.source_depth, elevation, one.range, work);
      if (work.segments.size() != segments || y.range != one.range || low.range != one.range ||
          high.range != one.range)
        continue;
      const double cosine = std::abs(y.xi) / std::hypot(y.xi, y.zeta);
      const double width = std::abs(high.depth - low.depth) * cosine / (2.0 * d);
      if (width < 50.0) continue;  // near a caustic the difference has its own error
      SCOPED_TRACE(testing::Message() << one.name << " at " << elevation);
      EXPECT_NEAR(std::abs(y.q) / width, 1.0, one.tolerance) << width;
      ++compared;
    }
    EXPECT_GT(compared, 15) << one.name;
  }
}

}  // namespace
}  // namespace asdic::detail
