#include <benchmark/benchmark.h>

#include <vector>

#include "core/units.h"
#include "raytrace/tracing/ray_tracer.h"
#include "support/oceans.h"
#include "support/sloping_seas.h"

// The marching solver's rates: dynamic rays (with delay, q, p, bounces and caustics) of fans over
// shelves, slopes, ridges, swell and fronts, on one core. A segment goes from line to line of the
// water, to a boundary or a turning point.
namespace asdic::detail {
namespace {

/// Where rays pass one range; nothing is stored.
class Last final : public RangeVisitor {
 public:
  double sum = 0.0;
  void pass(std::size_t, const RayState& y, const RayHistory&) override { sum += y.time + y.q; }
};

struct Fan {
  Environment ocean;
  double source_depth, range, widest;  // [m], [m], [rad]
};

void run(benchmark::State& state, const Fan& fan) {
  constexpr int rays = 1000;
  const RayTracer tracer(fan.ocean, 500.0);
  const auto angle = [&](int i) { return fan.widest * (2.0 * (i + 0.5) / rays - 1.0); };
  const TraceLimits limits{.min_range = -1.0, .max_range = fan.range};
  RayTrajectory ray;
  double segments = 0.0, length = 0.0;
  for (int i = 0; i < rays; ++i) {
    tracer.trace(0.0, fan.source_depth, angle(i), limits, ray);
    segments += static_cast<double>(ray.segments.size());
    length += ray.segments.back().end.length;
  }
  const std::vector<double> last = {fan.range - 1.0};
  Last passed;
  for (auto _ : state)
    for (int i = 0; i < rays; ++i)
      tracer.trace_past(last, 0.0, fan.source_depth, angle(i), limits, passed);
  benchmark::DoNotOptimize(passed.sum);
  constexpr auto rate = benchmark::Counter::kIsIterationInvariantRate;
  state.counters["rays/s"] = benchmark::Counter(rays, rate);
  state.counters["segments/s"] = benchmark::Counter(segments, rate);
  state.counters["m/segment"] = length / segments;
}

/// Rays within ±15° to 60 km, as those of RayFan in a layered ocean.
void BM_FanOverSlopes(benchmark::State& state) {
  const support::SlopingSea sea = support::sloping_seas()[static_cast<std::size_t>(state.range(0))];
  run(state, {sea.ocean, sea.source_depth, sea.ranges.back(), radians(15.0)});
  state.SetLabel(sea.name);
}
BENCHMARK(BM_FanOverSlopes)->DenseRange(0, 8)->Unit(benchmark::kMillisecond);

/// Steep rays, within 1 rad, to 8 km (swell: 3 km) through water of 900 m.
void BM_SteepFan(benchmark::State& state) {
  const support::CurvedOcean ocean =
      support::curved_oceans()[static_cast<std::size_t>(state.range(0))];
  run(state, {ocean.environment, ocean.source_depth, ocean.range, 1.0});
  state.SetLabel(ocean.name);
}
BENCHMARK(BM_SteepFan)->DenseRange(0, 9)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic::detail
