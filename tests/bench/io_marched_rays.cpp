#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "io/bellhop/case_reader.h"
#include "raytrace/beams/fan.h"
#include "raytrace/tracing/ray_tracer.h"

// Rays of the range-dependent reference cases, as marched: 500 over the fan of the case, to the end
// of its box. `times_bellhop` compares with the steps that BELLHOP takes over the same way at the
// step of 5 m that the goals name (and one more for every facet and every line of the water, for it
// shortens its steps there), at its 10 M steps/s; `..._converged` at the step of the case's
// converged run.
namespace asdic::detail {
namespace {

struct ReferenceCase {
  const char* name;
  double converged_step;  // [m]
};

constexpr ReferenceCase cases[] = {{"front-range-dependent", 5.0},
                                   {"seamount-curved", 5.0},
                                   {"wedge-gauss", 1.0},
                                   {"swell-surface", 0.5},
                                   {"rays-upslope", 20.0}};

void BM_MarchedRays(benchmark::State& state) {
  const ReferenceCase& one = cases[state.range(0)];
  const auto root = std::filesystem::path(ASDIC_TEST_DATA) / "bellhop" / one.name / "case";
  const PropagationCase run_case = bellhop::read_case(root).run_case;
  const RayTracer tracer(run_case.environment, run_case.frequency);
  const BeamFan fan = even_fan(run_case.beams.lowest, run_case.beams.highest, 500);
  const TraceLimits limits{.min_range = -run_case.box_range,
                           .max_range = run_case.box_range,
                           .max_depth = run_case.box_depth,
                           .faintest = 1e-4};
  RayTrajectory ray;
  double segments = 0.0, length = 0.0;
  for (const double elevation : fan.elevation) {
    tracer.trace(0.0, run_case.source_depths[0], elevation, limits, ray);
    segments += static_cast<double>(ray.segments.size());
    length += ray.segments.back().end.length;
  }
  for (auto _ : state)
    for (const double elevation : fan.elevation) {
      tracer.trace(0.0, run_case.source_depths[0], elevation, limits, ray);
      benchmark::DoNotOptimize(ray.segments.data());
    }
  using benchmark::Counter;
  const auto rays = static_cast<double>(fan.elevation.size());
  constexpr double bellhop_steps = 1e7;  // a second
  const auto each = Counter::kIsIterationInvariantRate;
  const auto per_item = each | Counter::kInvert;
  state.counters["segments/ray"] = segments / rays;
  state.counters["m/segment"] = length / segments;
  state.counters["s/segment"] = Counter(segments, per_item);
  state.counters["s/ray"] = Counter(rays, per_item);
  state.counters["times_bellhop"] = Counter((length / 5.0 + segments) / bellhop_steps, each);
  state.counters["times_bellhop_converged"] =
      Counter((length / one.converged_step + segments) / bellhop_steps, each);
  state.SetLabel(one.name);
}
BENCHMARK(BM_MarchedRays)->DenseRange(0, 4)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic::detail
