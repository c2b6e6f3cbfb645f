#include "sonar/ping.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <utility>

#include "core/error.h"
#include "sonar/echo.h"
#include "sonar/levels.h"
#include "sonar/noise.h"
#include "sonar/ping_bounds.h"
#include "sonar/reverberation.h"
#include "sonar/transmitter.h"

namespace asdic {
namespace {

constexpr std::size_t most_patch_rows = 2000;

/// Wall time since it was made or last read [s].
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

PingSimulator::PingSimulator(Scenario scenario)
    : scenario_(std::move(scenario)),
      transmissions_(asdic::transmissions(scenario_)),
      paths_(scenario_.environment, scenario_.transect),
      max_doppler_(doppler_bound(scenario_)) {
  for (std::size_t t = 0; t < scenario_.transmitters.size(); ++t)
    pulses_.emplace_back(pulse_of(scenario_, static_cast<int>(t)));
  const auto wider = [](const Pulse& a, const Pulse& b) {
    return a.bandwidth_40db() < b.bandwidth_40db();
  };
  reverberation_ = std::make_unique<ReverberationModel>(
      scenario_, paths_, *std::max_element(pulses_.begin(), pulses_.end(), wider));
  set_sea(scenario_.reverberation.surface, scenario_.wind_speed,
          speed_at_surface(scenario_, paths_));
}

Transmitter PingSimulator::transmitter(int ping) const {
  return projector_of(scenario_, transmission(ping));
}

double PingSimulator::ground_spacing() const { return reverberation_->ground_spacing(); }

PingRecord PingSimulator::blank_record(int ping, const Transmission& sent) const {
  const PingSchedule& schedule = scenario_.pings;
  PingRecord record;
  record.ping = ping;
  record.transmitter = sent.transmitter;
  record.start_time = sent.time;
  record.elevation = sent.elevation;
  record.platform = transmitter_at(scenario_, sent.transmitter, sent.time);
  for (const Target& target : scenario_.targets)
    record.targets.push_back(target.track.at(sent.time));
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    const Vec3 reference = array_at(scenario_, static_cast<int>(a), sent.time).position;
    for (const Vec3& phone : scenario_.arrays[a].phones) record.phones.push_back(reference + phone);
  }
  record.recording = {.sample_rate = schedule.sample_rate,
                      .start = schedule.recording_start,
                      .samples = static_cast<std::size_t>(
                          std::llround(schedule.recording_duration * schedule.sample_rate))};
  record.pressure.assign(record.phones.size() * record.recording.samples, 0.0F);
  return record;
}

Returns PingSimulator::echoes(const EchoContext& context, PingRecord& record) const {
  Returns returns;
  for (std::size_t i = 0; i < scenario_.targets.size(); ++i) {
    const Target& target = scenario_.targets[i];
    if (record.ping < target.first_ping || record.ping > target.last_ping) continue;
    TargetEchoes found = target_echoes(context, static_cast<int>(i));
    for (Leg& leg : found.legs) record.legs.push_back(std::move(leg));
    for (const EchoPath& echo : found.echoes) {
      returns.push_back(echo.heard);
      record.echoes.push_back(echo);
    }
  }
  return returns;
}

PingRecord PingSimulator::simulate(int ping) const {
  Stopwatch watch;
  const Transmission& sent = transmission(ping);
  const Transmitter projector = projector_of(scenario_, sent);
  const Pulse& sent_pulse = pulse(sent.transmitter);
  const double frequency = sent_pulse.centre_frequency();
  PingRecord record = blank_record(ping, sent);

  const double local_speed = paths_.speed_at(record.platform.position);
  const BeamPattern pattern(projector, local_speed / frequency);
  const double peak_pressure = std::numbers::sqrt2 * amplitude_from_db(projector.source_level_db) *
                               micropascal;  // at 1 m [Pa]
  const Synthesizer synthesizer(sent_pulse, record.recording, max_doppler_);
  record.timings.synthesis = watch.lap();

  LevelMeter levels(record.recording);
  Baseband heard, reverberated;                  // of all channels
  std::vector<PingReverberation> reverberation;  // [arrays]
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    // Echoes: source → target × target → array.
    const EchoContext context{.paths = paths_,
                              .scenario = scenario_,
                              .pattern = pattern,
                              .frequency = frequency,
                              .ping_time = sent.time,
                              .transmitter = sent.transmitter,
                              .array = static_cast<int>(a)};
    const Returns echo_returns = echoes(context, record);
    record.timings.eigenrays += watch.lap();
    append_channels(heard, synthesizer.baseband(echo_returns, scenario_.arrays[a].phones));
    // Reverberation: source → scatterer → array.
    reverberation.push_back(reverberation_->ping(
        {.pattern = pattern,
         .pulse = sent_pulse,
         .transmitter = sent.transmitter,
         .array = static_cast<int>(a),
         .time = sent.time,
         .ping = static_cast<std::uint32_t>(ping),
         .latest = record.recording.start +
                   static_cast<double>(record.recording.samples) / record.recording.sample_rate}));
    record.timings.rays += watch.lap();
    const Returns scattered = reverberation.back().returns();
    if (a == 0) record.patches = reverberation.back().rows(most_patch_rows).rows;
    record.timings.patches += watch.lap();
    append_channels(reverberated, synthesizer.baseband(scattered, scenario_.arrays[a].phones));
    record.timings.synthesis += watch.lap();
  }
  levels.add_echo(heard, peak_pressure);
  levels.add_reverberation(reverberated, peak_pressure);
  std::transform(heard.values.begin(), heard.values.end(), reverberated.values.begin(),
                 heard.values.begin(), std::plus<>{});
  synthesizer.add_passband(heard, peak_pressure, record.pressure);
  record.timings.synthesis += watch.lap();

  double noise_variance = 0.0;
  if (scenario_.noise.spectral_level_db) {
    const double rate = record.recording.sample_rate;
    add_white_noise(record.pressure, record.phones.size(), *scenario_.noise.spectral_level_db, rate,
                    scenario_.seed, static_cast<std::uint32_t>(ping));
    noise_variance = white_noise_variance(*scenario_.noise.spectral_level_db, rate);
  }
  levels.add_noise(noise_variance);
  record.levels = levels.series();
  record.summary = summarise(record, scenario_, sent_pulse,
                             [&](double t) { return reverberation.front().expected_db(t); });
  record.timings.noise = watch.lap();
  return record;
}

int run_pings(const PingSimulator& simulator, const std::function<void(PingRecord&&)>& sink,
              const PingOptions& options) {
  const int count = simulator.pings();
  int next = 1, done = 0;
  // Two pings in flight a thread keep the writer fed; more would only cost memory.
  const auto in_flight =
      static_cast<std::size_t>(std::max(2, tbb::this_task_arena::max_concurrency()));
  tbb::parallel_pipeline(
      in_flight,
      tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order,
                                  [&](tbb::flow_control& flow) {
                                    if (next > count || options.stop.stop_requested()) {
                                      flow.stop();
                                      return 0;
                                    }
                                    return next++;
                                  }) &
          tbb::make_filter<int, std::shared_ptr<PingRecord>>(
              tbb::filter_mode::parallel,
              [&](int ping) { return std::make_shared<PingRecord>(simulator.simulate(ping)); }) &
          tbb::make_filter<std::shared_ptr<PingRecord>, void>(
              tbb::filter_mode::serial_in_order, [&](const std::shared_ptr<PingRecord>& record) {
                sink(std::move(*record));
                ++done;
                if (options.progress) options.progress(done);
              }));
  return done;
}

}  // namespace asdic
