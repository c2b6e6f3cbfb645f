#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <filesystem>
#include <string>

#include "io/ping_file.h"
#include "io/scenario_reader.h"
#include "sonar/ping.h"

// The ping of the thesis: 60 s on 16 phones at 16 kHz, with target, reverberation and noise,
// written to HDF5.
namespace asdic {
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

}  // namespace
}  // namespace asdic
