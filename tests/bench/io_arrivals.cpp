#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <filesystem>
#include <string>

#include "io/bellhop/case_reader.h"
#include "raytrace/runs/arrivals_run.h"

// Arrivals of the two deep-source cases, search alone, on one core. BELLHOP at a step of 5 m, whose
// delays are right to 2 µs: 4.55 and 4.57 s (tests/bench/data/bellhop-perf/README.md).
namespace asdic::detail {
namespace {

void arrivals(benchmark::State& state, const char* name, double bellhop_seconds) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto root = std::filesystem::path(ASDIC_TEST_DATA) / "bellhop" / name / "case";
  const PropagationCase run_case = bellhop::read_case(root).run_case;
  for (auto _ : state) benchmark::DoNotOptimize(run_arrivals(run_case));
  state.counters["times BELLHOP"] =
      benchmark::Counter(bellhop_seconds, benchmark::Counter::kIsIterationInvariantRate);
}

void BM_DeepSourceCLinear(benchmark::State& state) {
  arrivals(state, "deep-source-arrivals", 4.55);
}
BENCHMARK(BM_DeepSourceCLinear)->Unit(benchmark::kMicrosecond);

void BM_DeepSourcePchip(benchmark::State& state) {
  arrivals(state, "deep-source-arrivals-pchip", 4.57);
}
BENCHMARK(BM_DeepSourcePchip)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace asdic::detail
