#include "core/normal.h"

#include <benchmark/benchmark.h>

#include <vector>

namespace asdic::detail {
namespace {

void normals(benchmark::State& state) {
  std::vector<float> values(1024);
  std::uint64_t first = 0;
  for (auto _ : state) {
    fill_normal(values, 1, Draw::ambient_noise, 0, 0, first);
    benchmark::DoNotOptimize(values.data());
    first += values.size();
  }
  state.counters["normals/s"] =
      benchmark::Counter(double(values.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(normals);

void normals_one_by_one(benchmark::State& state) {
  RandomStream stream(1, Draw::ambient_noise, 0, 0);
  for (auto _ : state) benchmark::DoNotOptimize(stream.normal());
  state.counters["normals/s"] =
      benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(normals_one_by_one);

}  // namespace
}  // namespace asdic::detail
