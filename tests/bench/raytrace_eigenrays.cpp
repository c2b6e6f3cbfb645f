#include <benchmark/benchmark.h>

#include <vector>

#include "core/units.h"
#include "raytrace/paths/boundary_paths.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/paths/ray_fan.h"
#include "raytrace/paths/trace_ray.h"
#include "raytrace/runs/arrivals_run.h"
#include "raytrace/tracing/marching_eigenrays.h"
#include "support/deep_ocean.h"
#include "support/oceans.h"

// Eigenrays, many receivers, and the surface patches of a whole ping, in the deep ocean of the
// thesis: source at 4500 m, target at 125 m and 30 km.
namespace asdic::detail {
namespace {

constexpr const char* laws[] = {"c-linear", "n2-linear", "spline", "pchip", "munk"};

Environment deep_ocean(std::int64_t kind) { return support::deep_ocean(laws[kind]); }

void name_profile(benchmark::State& state) { state.SetLabel(laws[state.range(0)]); }

constexpr PathLimits limits{
    .max_surface_bounces = 3, .max_bottom_bounces = 3, .max_launch_angle = 1.4};

void BM_EigenraysToOneReceiver(benchmark::State& state) {
  const EigenraySolver solver(deep_ocean(state.range(0)));
  std::size_t found = 0;
  double range = 30e3;
  for (auto _ : state) found += solver.find(4500.0, 125.0, range += 1e-3, 4000.0, limits).size();
  state.counters["eigenrays/s"] =
      benchmark::Counter(static_cast<double>(found), benchmark::Counter::kIsRate);
  name_profile(state);
}
BENCHMARK(BM_EigenraysToOneReceiver)->DenseRange(0, 4)->Unit(benchmark::kMicrosecond);

void BM_EigenraysToManyReceivers(benchmark::State& state) {
  const EigenraySolver solver(deep_ocean(state.range(0)));
  std::vector<double> ranges;
  for (int i = 0; i < 1000; ++i) ranges.push_back(1000.0 + 50.0 * i);
  for (auto _ : state) benchmark::DoNotOptimize(solver.find(4500.0, 125.0, ranges, 4000.0, limits));
  state.counters["receivers/s"] =
      benchmark::Counter(1000.0, benchmark::Counter::kIsIterationInvariantRate);
  name_profile(state);
}
BENCHMARK(BM_EigenraysToManyReceivers)->DenseRange(0, 4)->Unit(benchmark::kMillisecond);

/// Ground cells of 70 m: the pulse of the thesis, 1 s of Hann-windowed tone.
void BM_SurfacePathsOfAPing(benchmark::State& state) {
  const EigenraySolver solver(deep_ocean(state.range(0)));
  std::size_t paths = 0;
  for (auto _ : state)
    paths += boundary_paths(solver, 4500.0, BoundaryKind::surface, 70.0, 46e3, 4000.0,
                            {.max_surface_bounces = 1, .max_bottom_bounces = 1})
                 .size();
  state.counters["paths/s"] =
      benchmark::Counter(static_cast<double>(paths), benchmark::Counter::kIsRate);
  name_profile(state);
}
BENCHMARK(BM_SurfacePathsOfAPing)->DenseRange(0, 4)->Unit(benchmark::kMillisecond);

/// A run as a file of BELLHOP asks for it: 200 receivers near the surface out to 50 km, a lossy
/// bottom, no limit of bounces but what reflections leave.
void BM_ArrivalsOfARun(benchmark::State& state) {
  PropagationCase run_case;
  run_case.environment = deep_ocean(state.range(0));
  run_case.frequency = 4000.0;
  run_case.source_depths = {4500.0};
  run_case.receivers.depths = {5.0};
  for (int i = 1; i <= 200; ++i) run_case.receivers.ranges.push_back(250.0 * i);
  run_case.beams.lowest = -radians(89.0);
  run_case.beams.highest = radians(89.0);
  run_case.task = Task::arrivals;
  std::size_t arrivals = 0;
  for (auto _ : state)
    for (const Arrivals& here : run_arrivals(run_case).arrivals) arrivals += here.size();
  state.counters["arrivals/s"] =
      benchmark::Counter(static_cast<double>(arrivals), benchmark::Counter::kIsRate);
  name_profile(state);
}
BENCHMARK(BM_ArrivalsOfARun)->DenseRange(0, 4)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Eigenrays over slopes, swell and fronts: 15 receivers in three columns.
void BM_MarchingEigenrays(benchmark::State& state) {
  const support::CurvedOcean ocean =
      support::curved_oceans()[static_cast<std::size_t>(state.range(0))];
  const RayTracer tracer(ocean.environment, 500.0);
  std::vector<ReceiverPoint> receivers;
  for (const double part : {0.25, 0.6, 1.0})
    for (const double z : {5.0, 70.0, 200.0, 400.0, 600.0})
      receivers.push_back({part * ocean.range, z});
  std::size_t found = 0;
  for (auto _ : state)
    for (const Arrivals& here : marching_eigenrays(
             tracer, 0.0, ocean.source_depth, receivers,
             {.lowest = -1.2, .highest = 1.2, .max_surface_bounces = 6, .max_bottom_bounces = 6}))
      found += here.size();
  state.counters["eigenrays/s"] =
      benchmark::Counter(static_cast<double>(found), benchmark::Counter::kIsRate);
  state.SetLabel(ocean.name);
}
BENCHMARK(BM_MarchingEigenrays)->DenseRange(0, 9)->Unit(benchmark::kMillisecond)->UseRealTime();

/// To one receiver, at the far end and half way down; the processor time of all threads.
void BM_MarchingEigenraysToOne(benchmark::State& state) {
  const support::CurvedOcean ocean =
      support::curved_oceans()[static_cast<std::size_t>(state.range(0))];
  const RayTracer tracer(ocean.environment, 500.0);
  const ReceiverPoint receiver{ocean.range, 200.0};
  for (auto _ : state)
    benchmark::DoNotOptimize(marching_eigenrays(
        tracer, 0.0, ocean.source_depth, std::span(&receiver, 1),
        {.lowest = -1.2, .highest = 1.2, .max_surface_bounces = 6, .max_bottom_bounces = 6}));
  state.SetLabel(ocean.name);
}
BENCHMARK(BM_MarchingEigenraysToOne)
    ->DenseRange(0, 9)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

void BM_TraceRay(benchmark::State& state) {
  const Environment ocean = deep_ocean(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(trace_ray(ocean, 4500.0, 0.1, 100e3));
  state.counters["rays/s"] = benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
  name_profile(state);
}
BENCHMARK(BM_TraceRay)->DenseRange(0, 4)->Unit(benchmark::kMicrosecond);

/// Dynamic rays within ±15° to 100 km through 110 layers, without their paths.
void BM_Fan(benchmark::State& state) {
  const Environment ocean = support::munk_in_layers(110);
  const RayFan fan(ocean, 1000.0, 1000.0);
  std::vector<double> elevations;
  for (int i = 0; i < 5000; ++i) elevations.push_back(radians(-15.0 + 0.006 * (i + 0.5)));
  std::vector<RayAtRange> rays(elevations.size());
  for (auto _ : state) {
    fan.trace(elevations, 100e3, rays);
    benchmark::DoNotOptimize(rays.data());
  }
  state.counters["rays/s"] = benchmark::Counter(static_cast<double>(rays.size()),
                                                benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(BM_Fan)->Unit(benchmark::kMillisecond);

/// The first search between two depths of an ocean just built, and one between other depths of it.
void BM_EigenraysOfANewOcean(benchmark::State& state) {
  const Environment ocean = deep_ocean(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(EigenraySolver(ocean).find(4500.0, 125.0, 30e3, 4000.0, limits));
  name_profile(state);
}
BENCHMARK(BM_EigenraysOfANewOcean)->DenseRange(0, 4)->Unit(benchmark::kMicrosecond);

void BM_EigenraysToANewDepth(benchmark::State& state) {
  const EigenraySolver solver(deep_ocean(state.range(0)));
  double depth = 125.0;
  for (auto _ : state)
    benchmark::DoNotOptimize(solver.find(4500.0, depth += 1e-3, 30e3, 4000.0, limits));
  name_profile(state);
}
BENCHMARK(BM_EigenraysToANewDepth)->DenseRange(0, 4)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace asdic::detail
