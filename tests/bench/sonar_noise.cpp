#include <benchmark/benchmark.h>

#include <vector>

#include "sonar/noise/block_noise.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/scenario/array.h"

namespace asdic::detail {
namespace {

constexpr double rate = 16000.0;

BlockNoise noise_of(NoiseCoherence coherence) {
  const NoiseSettings wenz{.law = WenzNoise{}, .thermal = true};
  return {[wenz](double f) { return noise_density(wenz, f); },
          rate,
          0.0,
          line_array(16, 0.1875, 0.0, 0.3).phones,
          coherence,
          NoiseDirections{},
          1500.0,
          NoiseKey{}};
}

/// A minute of a towed array: 16 phones at 16 kHz. Argument: NoiseCoherence.
void a_minute_of_noise(benchmark::State& state) {
  const BlockNoise noise = noise_of(static_cast<NoiseCoherence>(state.range(0)));
  std::vector<float> rows(16 * 60 * 16000);
  for (auto _ : state) {
    noise.add(rows, 0, 1);
    benchmark::DoNotOptimize(rows.data());
  }
  state.counters["samples/s"] =
      benchmark::Counter(double(rows.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(a_minute_of_noise)
    ->DenseRange(0, 2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

/// What is done once a scenario: the factors.
void factors(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(noise_of(static_cast<NoiseCoherence>(state.range(0))).block());
}
BENCHMARK(factors)->DenseRange(1, 2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic::detail
