#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>
#include <sys/resource.h>

#include <filesystem>
#include <memory>
#include <string>

#include "io/ping/ping_file.h"
#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping.h"
#include "sonar/ping/run_pings.h"

// The ping of the thesis: 60 s on 16 phones at 16 kHz, with target, reverberation and noise,
// written to HDF5.
namespace asdic::detail {
namespace {

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void ping(benchmark::State& state, const std::string& path) {
  const Scenario scenario = read_scenario(path);
  const auto file = std::filesystem::temp_directory_path() / "asdic_bench_ping.h5";
  for (auto _ : state) {
    const PingSimulator simulator(scenario);  // nothing is kept from the last one
    PingFileWriter writer(file, scenario, {});
    run_pings(simulator, [&](PingRecord&& record) { writer.append(record); });
    writer.finish(true);
  }
  std::filesystem::remove(file);
  state.counters["pings/s"] =
      benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["x real time"] = benchmark::Counter(scenario.pings.recording_duration,
                                                     benchmark::Counter::kIsIterationInvariantRate);
  state.counters["peak MB"] = peak_memory_mb();
}

void BM_PingOfTheDeepOcean(benchmark::State& state) {
  ping(state, ASDIC_SCENARIOS "/deep_ocean.toml");
}
BENCHMARK(BM_PingOfTheDeepOcean)->UseRealTime()->Unit(benchmark::kMillisecond)->MinTime(3.0);

// 35 s over a real sea floor and section, 12 planes of reverberation: rays are marched.
void BM_PingOverASeamount(benchmark::State& state) {
  ping(state, ASDIC_SCENARIOS "/seamount_ping.toml");
}
BENCHMARK(BM_PingOverASeamount)->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);

/// The deep ocean's ping as a vehicle's processor wants it: complex samples at 400 Hz about 4 kHz.
Scenario in_baseband(bool reverberation) {
  Scenario s = read_scenario(ASDIC_SCENARIOS "/deep_ocean.toml");
  s.pings.samples = Samples::baseband;
  s.pings.carrier = 4000.0;
  s.pings.baseband_rate = 400.0;
  s.reverberation.enabled = reverberation;
  return s;
}

void set_rate(benchmark::State& state) {
  state.counters["pings/s"] =
      benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
}

/// One core. A ping of a study: a simulator of its own, the propagation known, a new seed.
void cached_ping(benchmark::State& state, bool reverberation) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  Scenario scenario = in_baseband(reverberation);
  const auto shared = std::make_shared<SharedPropagation>();
  for (auto _ : state) {
    ++scenario.seed;
    benchmark::DoNotOptimize(PingSimulator(scenario, shared).simulate(1));
  }
  set_rate(state);
}
BENCHMARK_CAPTURE(cached_ping, noise_and_echoes, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cached_ping, with_reverberation, true)->Unit(benchmark::kMillisecond);

/// One core, nothing known.
void new_ping(benchmark::State& state, bool reverberation) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Scenario scenario = in_baseband(reverberation);
  for (auto _ : state) benchmark::DoNotOptimize(PingSimulator(scenario).simulate(1));
  set_rate(state);
}
BENCHMARK_CAPTURE(new_ping, noise_and_echoes, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(new_ping, with_reverberation, true)->Unit(benchmark::kMillisecond);

/// Levels alone, as a study of detection asks for. Argument: whether propagation is known.
void levels_of_ping(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Scenario scenario = in_baseband(true);
  const auto shared = std::make_shared<SharedPropagation>();
  for (auto _ : state)
    benchmark::DoNotOptimize(PingSimulator(scenario, state.range(0) ? shared : nullptr).levels(1));
  set_rate(state);
}
BENCHMARK(levels_of_ping)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic::detail
