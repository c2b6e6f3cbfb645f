#include "raytrace/paths/ray_fan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/units.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {
namespace {

class Last final : public RangeVisitor {
 public:
  void pass(std::size_t, const RayState& y, const RayHistory& history) override {
    state = y;
    passed = history;
    seen = true;
  }
  RayState state;
  RayHistory passed;
  bool seen = false;
};

/// 110 layers in 5000 m, speeds going up and down about Munk's.
Environment layered_ocean(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> kick(-0.4, 0.4);
  const SoundSpeedProfile munk = SoundSpeedProfile::munk();
  std::vector<double> z, c;
  for (int i = 0; i <= 110; ++i) {
    z.push_back(5000.0 * i / 110);
    c.push_back(munk.at(z.back()).c + kick(random));
  }
  Environment ocean{.water = SoundSpeedProfile::table(z, c, Interpolation::c_linear)};
  ocean.bottom = {.depth = 5000.0, .material = FluidHalfSpace{}};
  return ocean;
}

// Counted cycles against followed ones, of rays up and down, flat and steep, at ranges within the
// first leg and beyond many cycles. Both are closed forms; rounding grows with the number of
// segments and with |q|: a launch angle's 1e-16/θ turns into 1e-15·q of depth, and a node grazed at
// s = 1e-4 into a thousand times that.
TEST(RayFan, CountsTheCyclesThatATracerFollows) {
  for (const unsigned seed : {1U, 2U}) {
    const Environment ocean = layered_ocean(seed);
    for (const double source : {100.0, 1000.0, 3333.0, 5000.0 / 110 * 20}) {
      const RayFan fan(ocean, 1000.0, source);
      const RayTracer tracer(ocean, 1000.0);
      std::vector<double> elevations;
      for (int i = 0; i < 200; ++i) elevations.push_back(radians(-40.0 + 80.0 * (i + 0.31) / 200));
      std::vector<RayAtRange> rays(elevations.size());
      for (const double range : {300.0, 4321.0, 30e3, 100e3}) {
        fan.trace(elevations, range, rays);
        int compared = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
          Last last;
          tracer.trace_past(std::span(&range, 1), 0.0, source, elevations[i],
                            {.max_range = range + 10.0}, last);
          ASSERT_TRUE(last.seen && rays[i].arrived);
          const RayAtRange& ray = rays[i];
          SCOPED_TRACE(testing::Message() << source << " m, " << range << " m, " << elevations[i]);
          const double size = std::abs(last.state.q) + range;
          EXPECT_NEAR(ray.depth, last.state.depth, 1e-11 * size);
          EXPECT_NEAR(ray.time, last.state.time, 1e-14 * size);
          EXPECT_NEAR(ray.elevation, -std::atan2(last.state.zeta, last.state.xi),
                      1e-12 + 1e-10 * std::abs(last.state.p) * 1500.0);
          EXPECT_NEAR(ray.q, last.state.q, 1e-6 * size);
          EXPECT_NEAR(ray.p, last.state.p, 1e-6 * (std::abs(last.state.p) + 1.0 / 1500.0));
          EXPECT_EQ(ray.surface_bounces, last.passed.surface_bounces);
          EXPECT_EQ(ray.bottom_bounces, last.passed.bottom_bounces);
          EXPECT_EQ(ray.turns, last.passed.upper_turns + last.passed.lower_turns);
          EXPECT_EQ(ray.caustics, last.passed.caustics);
          EXPECT_NEAR(std::abs(ray.reflection - last.passed.reflection), 0.0, 1e-9);
          ++compared;
        }
        EXPECT_EQ(compared, 200);
      }
    }
  }
}

// Any other ocean is marched: the same rays, asked for one by one.
TEST(RayFan, AnyOcean) {
  Environment ocean{.water = SoundSpeedProfile::munk()};
  ocean.bottom = {.depth = 5000.0, .material = Rigid{}};
  const RayFan fan(ocean, 1000.0, 1000.0);
  const RayTracer tracer(ocean, 1000.0);
  const std::vector<double> elevations = {-0.2, -0.01, 0.0, 0.1};
  std::vector<RayAtRange> rays(elevations.size());
  const double range = 20e3;
  fan.trace(elevations, range, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Last last;
    tracer.trace_past(std::span(&range, 1), 0.0, 1000.0, elevations[i],
                      {.max_range = 1.001 * range + 1.0}, last);
    EXPECT_EQ(rays[i].depth, last.state.depth);
    EXPECT_EQ(rays[i].q, last.state.q);
  }
}

}  // namespace
}  // namespace asdic::detail
