#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <vector>

#include "core/normal.h"
#include "processing/detector.h"
#include "processing/listening_band.h"
#include "processing/matched_filter.h"
#include "sonar/scenario/array.h"

namespace asdic::detail {
namespace {

constexpr double rate = 16000.0, seconds = 60.0;

/// A minute of noise at 16 phones, from the samples to the detections. Arguments: threads; swept
/// band [Hz], 0 a Hann tone. Doppler filters to ±15 m/s.
void detections(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(0)));
  const auto swept = static_cast<double>(state.range(1));
  const PulseSettings tone{.waveform = Cw{}, .duration = 1.0};
  const PulseSettings sweep{.waveform = Lfm{.start_frequency = 4000.0 - 0.5 * swept,
                                            .end_frequency = 4000.0 + 0.5 * swept},
                            .duration = 1.0,
                            .window = PulseWindow::tukey};
  const Replica pulse(std::span<const float>(replica(Pulse(swept > 0.0 ? sweep : tone), rate)),
                      rate);
  const ReceiverArray array = line_array(16, 0.1875, 0.0, 0.0);
  std::vector<float> pressure(static_cast<std::size_t>(rate * seconds) * 16);
  fill_normal(pressure, 1, Draw::ambient_noise, 0, 0);
  const std::vector<double> bank = doppler_bank(pulse, 0.0214);
  const double width = 2.0 * (0.0214 * 4000.0 + 0.75 * pulse.bandwidth());
  for (auto _ : state) {
    const Baseband received =
        to_baseband(pressure, 16, rate, 0.0, {.centre = 4000.0, .width = width}, 1.1);
    benchmark::DoNotOptimize(detect(received, array.phones, 1500.0, pulse, bank, {}));
  }
  state.counters["filters"] = static_cast<double>(bank.size());
  state.counters["times real time"] =
      benchmark::Counter(seconds, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(detections)
    ->ArgsProduct({{1, 2}, {0, 100, 1000}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace asdic::detail
