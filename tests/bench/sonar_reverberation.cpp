#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <vector>

#include "sonar/ping/ping.h"
#include "sonar/reverberation/reverberation_model.h"
#include "sonar/scenario/array.h"
#include "sonar/synthesis/synthesis.h"
#include "support/deep_ocean.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// The full density at 100 Hz of bandwidth: rings for a Hann-windowed LFM, 36 sectors, one minute;
/// phones at 16 kHz out of a baseband of some 400 Hz.
struct FullDensity {
  explicit FullDensity(bool bistatic, double speed)
      : scenario(support::thesis(SoundSpeedProfile::isovelocity(1500.0))),
        paths(scenario.environment, scenario.transect),
        pulse({.waveform = Lfm{}, .duration = 1.0}),
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
  const ReverberationContext context{.geometry = PingGeometry(sea.scenario, {}, 1),
                                     .pattern = sea.pattern,
                                     .pulse = sea.pulse,
                                     .latest = 60.0};
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
  const ReverberationContext context{.geometry = PingGeometry(sea.scenario, {}, 1),
                                     .pattern = sea.pattern,
                                     .pulse = sea.pulse,
                                     .latest = 60.0};
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

/// A ping of 60 s after the first: 16 phones in complex baseband, reverberation of the surface and
/// noise in deep water. \param sweep  of an LFM of 1 s [Hz]; 0: a tone
Scenario one_minute(double sweep, PulseWindow window) {
  Scenario s = support::thesis(support::deep_ocean("pchip").water);
  s.environment.absorption = Thorp{};
  std::get<LineBeam>(s.transmitters[0].beam).taper = Taper::hann;
  s.pulse.duration = 1.0;
  s.pulse.window = window;
  if (sweep > 0.0) s.pulse.waveform = Lfm{4000.0 - 0.5 * sweep, 4000.0 + 0.5 * sweep};
  s.arrays[0] = line_array(16, 0.1875, 0.0, 0.0);
  s.noise.law = WhiteNoise{40.0};
  s.reverberation.enabled = true;
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.pings.count = 1000;
  s.pings.recording_duration = s.pings.interval = 60.0;
  s.pings.samples = Samples::baseband;
  return s;
}

/// Where the array is and how the vehicle goes.
enum class Way { rest, crawl, astern, under_way, snake, snake_at_rest };

/// Arguments: Way, sweep [Hz] (0: a tone), whether there is a window.
void ping_sequence(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const auto way = static_cast<Way>(state.range(0));
  Scenario s = one_minute(double(state.range(1)),
                          state.range(2) != 0 ? PulseWindow::hann : PulseWindow::none);
  const bool snake = way == Way::snake || way == Way::snake_at_rest;
  if (way == Way::crawl) s.platforms[0].track.start.velocity = {1e-6, 0.0, 0.0};
  if (way == Way::under_way || way == Way::snake)
    s.platforms[0].track.start.velocity = {0.0, 1.7, 0.0};
  if (way == Way::astern || way == Way::snake) s.arrays[0].offset = {0.0, -30.0, 0.0};
  for (int ping = 0; snake && ping < 16; ++ping) {
    std::vector<Vec3> shape = s.arrays[0].phones;
    for (Vec3& x : shape)
      x += Vec3(0.1 * ping * std::sin(1.6 * x.y() + ping), 0.0, 0.1 * std::cos(2.0 * x.y() * ping));
    s.arrays[0].shapes.push_back(shape);
  }
  const PingSimulator simulator(s);
  static_cast<void>(simulator.simulate(1));
  int ping = 1;
  for (auto _ : state) benchmark::DoNotOptimize(simulator.simulate(++ping));
}
BENCHMARK(ping_sequence)
    ->ArgNames({"way", "sweep", "window"})
    ->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 100}, {1}})
    ->Args({4, 20, 1})
    ->Args({4, 200, 1})
    ->Args({4, 100, 0})
    ->Iterations(12)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic::detail
