#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include "core/units.h"
#include "raytrace/beams/layered_crossings.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/paths/ray_fan.h"
#include "raytrace/tracing/marching_eigenrays.h"
#include "raytrace/tracing/ray_tracer.h"
#include "support/deep_ocean.h"
#include "support/oceans.h"

namespace {
std::atomic<std::size_t> allocations = 0;
}

// Of this whole test program; what other tests allocate counts for nothing.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size > 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace asdic::detail {
namespace {

template <class Work>
std::size_t allocations_of(const Work& work) {
  work();  // memory that is kept grows once
  const std::size_t before = allocations;
  work();
  return allocations - before;
}

// The search allocates for its results (a list a receiver, a list of bounces a path), for the
// intervals of the fan (one block each) and their series, and a score of lists besides, which grow
// by doubling; never for a ray, a node, a Newton step. 1 + 1 bounces, so that most paths have a
// list of bounces; a bound of each, from the profile's 33 cuts.
TEST(Allocations, OfALayeredSearchAreBoundedByItsResults) {
  for (const char* law : {"c-linear", "n2-linear", "pchip", "spline", "munk"}) {
    const EigenraySolver solver(support::deep_ocean(law));
    const PathLimits limits{.max_surface_bounces = 3, .max_bottom_bounces = 3};
    for (const int receivers : {1, 100, 1000}) {
      std::vector<double> ranges;
      for (int i = 0; i < receivers; ++i) ranges.push_back(30e3 + 20.0 * i);
      std::size_t paths = 0;
      const std::size_t count = allocations_of([&] {
        paths = 0;
        for (const Arrivals& here : solver.find(4500.0, 125.0, ranges, 1000.0, limits))
          paths += here.size();
      });
      constexpr std::size_t intervals = 40, series_each = 16;
      EXPECT_LE(count, paths + ranges.size() + intervals * (3 + series_each) + 60)
          << law << ", " << receivers << " receivers, " << paths << " paths";
      if (receivers == 1) {
        EXPECT_LE(count, paths + intervals * 6 + 60) << law;
      }
    }
  }
}

// Rays that are followed without being stored, and those that reuse a trajectory, allocate nothing.
TEST(Allocations, NoneOfATracedRay) {
  class Nothing final : public RangeVisitor {
   public:
    void pass(std::size_t, const RayState&, const RayHistory&) override {}
  } nothing;
  const std::vector<double> ranges = {1000.0, 2000.0, 5000.0};
  for (const support::CurvedOcean& ocean : support::curved_oceans()) {
    const RayTracer tracer(ocean.environment, 1000.0);
    const TraceLimits limits{.max_range = ocean.range};
    RayTrajectory ray;
    EXPECT_EQ(allocations_of([&] {
                for (const double angle : {-0.4, -0.1, 0.05, 0.3})
                  tracer.trace_past(ranges, 0.0, ocean.source_depth, angle, limits, nothing);
              }),
              0U)
        << ocean.name;
    EXPECT_EQ(allocations_of([&] {
                for (const double angle : {-0.4, -0.1, 0.05, 0.3})
                  tracer.trace(0.0, ocean.source_depth, angle, limits, ray);
              }),
              0U)
        << ocean.name;
  }
}

// A search over slopes, ridges and fronts allocates for its results (a list a receiver, which grows
// by doubling, a list of bounces a path) and for the rays that it keeps to compare: the 33 ends of
// the fan's first intervals, one for each depth of splitting, 58 at most, and some for families of
// roots, each of legs, parts and crossings that grow by doubling to a few dozen. Never for another
// ray, a segment, an event, a Newton step, of which there are hundreds of thousands here.
TEST(Allocations, OfAMarchingSearchAreBoundedByItsResults) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  constexpr std::size_t kept_rays = 33 + 58, arrays_each = 3, doublings = 6;
  for (const support::CurvedOcean& ocean : support::curved_oceans()) {
    const RayTracer tracer(ocean.environment, 1000.0);
    for (const int n : {1, 10, 1000}) {
      std::vector<ReceiverPoint> receivers;
      for (int i = 0; i < n; ++i)
        receivers.push_back({0.8 * ocean.range, 20.0 + 330.0 * (i + 0.5) / n});
      std::size_t paths = 0;
      SearchWatch watch;
      const std::size_t count = allocations_of([&] {
        paths = 0;
        watch = {};
        for (const Arrivals& here : marching_eigenrays(tracer, 0.0, ocean.source_depth, receivers,
                                                       {.lowest = -1.2,
                                                       .highest = 1.2,
                                                       .max_surface_bounces = 4,
                                                       .max_bottom_bounces = 4},
                                                       &watch))
          paths += here.size();
      });
      const std::size_t lists_of_paths = 5 * receivers.size();  // 1, 2, 4, 8, 16 of them
      EXPECT_LE(count, paths + lists_of_paths + kept_rays * arrays_each * doublings)
          << ocean.name << ", " << n << " receivers, " << paths << " paths, " << watch.cost.rays
          << " rays of " << watch.cost.segments << " segments";
      if (n == 1000) {
        EXPECT_GT(watch.cost.segments, 50 * kept_rays * arrays_each * doublings);
      }
    }
  }
}

// A fan's memory is its workspace: four blocks, however many rays.
TEST(Allocations, OfAFanDoNotGrowWithItsRays) {
  const Environment ocean = support::deep_ocean("c-linear");
  const RayFan fan(ocean, 1000.0, 1000.0);
  std::vector<double> elevations;
  for (int i = 0; i < 1000; ++i) elevations.push_back(radians(-15.0 + 0.03 * (i + 0.5)));
  std::vector<RayAtRange> rays(elevations.size());
  EXPECT_LE(allocations_of([&] { fan.trace(elevations, 100e3, rays); }), 4U);
}

// Beams' crossings reuse their arrays from ray to ray.
TEST(Allocations, NoneOfABeamsCrossings) {
  const Environment ocean = support::deep_ocean("c-linear");
  std::vector<double> ranges;
  for (int i = 1; i <= 500; ++i) ranges.push_back(200.0 * i);
  const auto layered = LayeredCrossings::make(ocean, 50.0, 1000.0, ranges, {.max_range = 101e3});
  ASSERT_TRUE(layered);
  LayeredCrossings::Workspace work;
  Crossings out;
  EXPECT_EQ(allocations_of([&] {
              for (const double angle : {-0.3, -0.1, 0.05, 0.2}) layered->find(angle, work, out);
            }),
            0U);
}

}  // namespace
}  // namespace asdic::detail
