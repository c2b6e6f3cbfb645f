#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <vector>

#include "sonar/scenario/array.h"
#include "sonar/synthesis/synthesis.h"
#include "support/random_returns.h"

namespace asdic::detail {
namespace {

constexpr double rate = 16000.0, seconds = 60.0;
const Recording minute = {
    .sample_rate = rate, .start = 0.0, .samples = static_cast<std::size_t>(rate * seconds)};
const ReceiverArray array = line_array(16, 0.1875, 0.0, 0.0);

Returns reverberation(std::size_t count, double spread) {
  return support::RandomReturns{.count = count, .last = seconds, .spread = spread}.make();
}

const PulseSettings hann_tone = {.waveform = Cw{}, .duration = 1.0};
const PulseSettings hann_sweep = {.waveform = Lfm{}, .duration = 1.0};

/// 100 000 patches at 16 phones. Argument: span of Doppler factors, ±n·10⁻⁴.
void baseband(benchmark::State& state, const PulseSettings& settings) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
  const double spread = 1e-4 * static_cast<double>(state.range(0));
  const Returns returns = reverberation(100'000, spread);
  const Synthesizer synthesizer(Pulse(settings), minute, spread);
  for (auto _ : state) benchmark::DoNotOptimize(synthesizer.baseband(returns, array.phones));
  state.counters["returns·phones/s"] = benchmark::Counter(
      double(returns.size() * array.phones.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(baseband, hann_tone, hann_tone)
    ->Arg(0)
    ->Arg(5)
    ->Arg(35)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(baseband, hann_sweep, hann_sweep)
    ->Arg(0)
    ->Arg(5)
    ->Arg(35)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// Scatterers of 4 kHz of sweep on a minute of baseband. Arguments: scatterers, phones.
void wide_sweep(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
  const ReceiverArray many = line_array(static_cast<int>(state.range(1)), 0.1875, 0.0, 0.0);
  const Returns returns = reverberation(static_cast<std::size_t>(state.range(0)), 0.0);
  const Synthesizer synthesizer(
      Pulse({.waveform = Lfm{.start_frequency = 3000.0, .end_frequency = 7000.0}, .duration = 1.0}),
      minute, 0.0);
  for (auto _ : state) benchmark::DoNotOptimize(synthesizer.baseband(returns, many.phones));
  state.counters["returns·phones/s"] = benchmark::Counter(
      double(returns.size() * many.phones.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(wide_sweep)
    ->Args({100'000, 32})
    ->Args({200'000, 32})
    ->Args({400'000, 32})
    ->Args({800'000, 32})
    ->Args({100'000, 8})
    ->Args({100'000, 16})
    ->Args({100'000, 64})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// A whole minute of 16 phones at 16 kHz: planning, 100 000 returns, baseband, passband.
void whole_ping(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
  const double spread = 1e-4 * static_cast<double>(state.range(0));
  const Returns returns = reverberation(100'000, spread);
  const Pulse pulse(hann_tone);
  std::vector<float> pressure(array.phones.size() * minute.samples);
  for (auto _ : state) {
    const Synthesizer synthesizer(pulse, minute, spread);
    synthesizer.add_samples(synthesizer.baseband(returns, array.phones), 1.0, pressure);
  }
  state.counters["samples/s"] =
      benchmark::Counter(double(pressure.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(whole_ping)->Arg(0)->Arg(5)->Arg(35)->UseRealTime()->Unit(benchmark::kMillisecond);

void passband(benchmark::State& state) {
  const Synthesizer synthesizer(Pulse(hann_tone), minute, 0.0);
  const Baseband b = synthesizer.baseband(reverberation(100, 0.0), array.phones);
  std::vector<float> pressure(array.phones.size() * minute.samples);
  for (auto _ : state) synthesizer.add_samples(b, 1.0, pressure);
  state.counters["samples/s"] =
      benchmark::Counter(double(pressure.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(passband)->UseRealTime()->Unit(benchmark::kMillisecond);

void planning(benchmark::State& state) {
  const Pulse pulse(hann_tone);
  for (auto _ : state) benchmark::DoNotOptimize(Synthesizer(pulse, minute, 0.0035));
}
BENCHMARK(planning)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic::detail
