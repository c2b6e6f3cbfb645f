#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include "sonar/reverberation.h"
#include "sonar/synthesis.h"
#include "support/thesis.h"

namespace asdic {
namespace {

/// The full density at 100 Hz of bandwidth: rings for a Hann-windowed LFM, 36 sectors, one minute;
/// phones at 16 kHz out of a baseband of some 400 Hz.
struct FullDensity {
  explicit FullDensity(bool bistatic, double speed)
      : scenario(support::thesis(SoundSpeedProfile::isovelocity(1500.0))),
        paths(scenario.environment, scenario.transect),
        pulse({.kind = PulseKind::lfm, .duration = 1.0}),
        pattern(scenario.transmitters[0], 0.375) {
    scenario.platforms[0].track.start.position = {0.0, 0.0, 1000.0};
    scenario.platforms[0].track.start.velocity = {speed, 0.0, 0.0};
    scenario.arrays[0].phones = {Vec3::Zero()};
    if (bistatic) {
      scenario.platforms.push_back(scenario.platforms[0]);
      scenario.platforms[1].track.start.position = {8000.0, 0.0, 500.0};
      scenario.arrays[0].platform = 1;
    }
    scenario.reverberation.enabled = true;
    scenario.reverberation.ground_spacing = 1.8;  // 25 000 rings
    scenario.reverberation.resolve_azimuth = false;
  }

  Scenario scenario;
  PropagationPaths paths;
  Pulse pulse;
  BeamPattern pattern;
  Recording minute{.sample_rate = 16000.0, .start = 0.0, .samples = 960'000};
};

/// Scatterers to returns to baseband. Arguments: bistatic, platform's speed [m/s].
void full_density(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
  const FullDensity sea(state.range(0) != 0, double(state.range(1)));
  const ReverberationModel model(sea.scenario, sea.paths, sea.pulse);
  const double span = 2.2 * double(state.range(1)) / 1300.0;
  const Synthesizer synthesizer(sea.pulse, sea.minute, span);
  const ReverberationContext context{.pattern = sea.pattern, .pulse = sea.pulse, .latest = 60.0};
  static_cast<void>(model.ping(context));  // the fans, traced once
  std::size_t scatterers = 0, returns = 0;
  for (auto _ : state) {
    const PingReverberation ping = model.ping(context);
    returns = static_cast<std::size_t>(ping.expected_returns());
    scatterers = ping.fields()[0].grid.rings * std::size_t(36);
    benchmark::DoNotOptimize(synthesizer.baseband(ping, sea.scenario.arrays[0].phones));
  }
  state.counters["scatterers"] = double(scatterers);
  state.counters["returns"] = double(returns);
}
BENCHMARK(full_density)
    ->Args({0, 0})
    ->Args({0, 2})
    ->Args({1, 0})
    ->Args({1, 2})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// Of that, the returns alone.
void scatter(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
  const FullDensity sea(state.range(0) != 0, double(state.range(1)));
  const ReverberationModel model(sea.scenario, sea.paths, sea.pulse);
  const ReverberationContext context{.pattern = sea.pattern, .pulse = sea.pulse, .latest = 60.0};
  const PingReverberation ping = model.ping(context);
  for (auto _ : state) benchmark::DoNotOptimize(ping.returns());
}
BENCHMARK(scatter)
    ->Args({0, 0})
    ->Args({0, 2})
    ->Args({1, 0})
    ->Args({1, 2})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic
