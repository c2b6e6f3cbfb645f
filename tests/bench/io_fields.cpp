#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <filesystem>
#include <string>

#include "io/bellhop/case_reader.h"
#include "raytrace/runs/field_run.h"

// The coherent field of 5000 beams on 501 × 201 receivers to 100 km, tracing and accumulation;
// threads as told. BELLHOP on one core of the same class of machine: hat 0.63 s, Gaussian 1.8 s, at
// a step of 500 m (tests/bench/data/bellhop-perf/README.md).
namespace asdic::detail {
namespace {

void field(benchmark::State& state, const char* name, FieldMethod method) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  const auto root = std::filesystem::path(ASDIC_OWN_DATA) / "bellhop-perf" / name;
  const PropagationCase run_case = bellhop::read_case(root).run_case;
  const RayTracer tracer(run_case.environment, run_case.frequency);
  const BeamFan fan =
      even_fan(run_case.beams.lowest, run_case.beams.highest, run_case.literal.beams);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        field_of_fan(run_case, tracer, run_case.source_depths[0], fan, {}, method));
  state.counters["beams/s"] = benchmark::Counter(static_cast<double>(fan.elevation.size()),
                                                 benchmark::Counter::kIsIterationInvariantRate);
}

void BM_HatField(benchmark::State& state) {
  field(state, "a-munk-coherent-5000", FieldMethod::fast);
}
BENCHMARK(BM_HatField)->Arg(1)->Arg(2)->Arg(4)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_GaussianField(benchmark::State& state) {
  field(state, "a-munk-coherent-gauss-5000", FieldMethod::fast);
}
BENCHMARK(BM_GaussianField)->Arg(1)->Arg(2)->Arg(4)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_HatFieldPlain(benchmark::State& state) {
  field(state, "a-munk-coherent-5000", FieldMethod::plain);
}
BENCHMARK(BM_HatFieldPlain)->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic::detail
