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
#include "reverb/patches.h"
#include "sonar/echo.h"
#include "sonar/levels.h"
#include "sonar/noise.h"
#include "sonar/reverberation.h"
#include "sonar/transmitter.h"

namespace asdic {
namespace {

constexpr std::size_t most_patch_rows = 2000;
constexpr double finest_ground = 1.0;  // [m]

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

double fastest(const Track& track) {
  double speed = track.waypoints.empty() ? track.start.velocity.norm() : 0.0;
  for (std::size_t i = 0; i + 1 < track.waypoints.size(); ++i) {
    const Waypoint &a = track.waypoints[i], &b = track.waypoints[i + 1];
    speed = std::max(speed, (b.position - a.position).norm() / (b.time - a.time));
  }
  return speed;
}

/// A bound on |η − 1| over everything in the scenario: each of source, target (twice) and receiver
/// contributes at most v/c.
double doppler_bound(const Scenario& scenario) {
  double target = 0.0;
  for (const Target& t : scenario.targets) target = std::max(target, fastest(t.track));
  const double platform = fastest(scenario.platform);
  constexpr double slowest_sea = 1300.0;
  return 2.2 * (platform + target) / slowest_sea;
}

/// At the surface over the platform's first place [m/s].
double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths) {
  Vec3 place = scenario.platform.at(0.0).position;
  place.z() = paths.surface_depth(place);
  return paths.speed_at(place);
}

double fastest_water(const Environment& ocean) {
  double fastest = 0.0;
  if (ocean.section) {
    for (const double c : ocean.section->speeds()) fastest = std::max(fastest, c);
    return fastest;
  }
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  for (double z = 0.0; z <= bottom; z += 50.0) fastest = std::max(fastest, ocean.water.at(z).c);
  return fastest;
}

/// By default from the pulse's bandwidth; a surface with a shape is sampled facet by facet.
double ground_grid(const Scenario& scenario, const Pulse& pulse, const PropagationPaths& paths) {
  if (scenario.reverberation.ground_spacing) return *scenario.reverberation.ground_spacing;
  const double by_pulse =
      asdic::ground_spacing(pulse.bandwidth_40db(), speed_at_surface(scenario, paths));
  const auto& shape = scenario.environment.surface.shape;
  if (!shape || shape->ranges().size() < 2) return by_pulse;
  const double facet = (shape->ranges().back() - shape->ranges().front()) /
                       static_cast<double>(shape->ranges().size() - 1);
  return std::min(by_pulse, std::max(facet, finest_ground));
}

SurfaceGround::Settings ground_settings(const Scenario& scenario, const Pulse& pulse,
                                        const PropagationPaths& paths) {
  const PingSchedule& pings = scenario.pings;
  return {.azimuths = scenario.reverberation.azimuths,
          .spacing = ground_grid(scenario, pulse, paths),
          .max_range = 0.5 * fastest_water(scenario.environment) *
                       (pings.recording_start + pings.recording_duration),
          .frequency = pulse.centre_frequency(),
          .limits = limits_of(scenario.propagation)};
}

}  // namespace

PingSimulator::PingSimulator(Scenario scenario)
    : scenario_(std::move(scenario)),
      pulse_(scenario_.pulse),
      paths_(scenario_.environment, scenario_.transect),
      ground_(paths_, ground_settings(scenario_, pulse_, paths_)),
      max_doppler_(doppler_bound(scenario_)) {
  set_sea(scenario_.reverberation.surface, scenario_.wind_speed,
          speed_at_surface(scenario_, paths_));
}

Transmitter PingSimulator::transmitter(int ping) const {
  Transmitter transmitter = scenario_.transmitter;
  const auto& sweep = scenario_.pings.elevations;
  if (!sweep.empty())
    transmitter.elevation = sweep[static_cast<std::size_t>(ping - 1) % sweep.size()];
  return transmitter;
}

double PingSimulator::ground_spacing() const { return ground_.settings().spacing; }

std::vector<SectorPatches> PingSimulator::surface_patches(const Vec3& platform,
                                                          Timings& timings) const {
  Stopwatch watch;
  const auto planes = ground_.around(platform);
  timings.rays = watch.lap();
  std::vector<SectorPatches> found(planes->size());
  tbb::parallel_for(std::size_t{0}, planes->size(), [&](std::size_t i) {
    const GroundSectors& plane = (*planes)[i];
    found[i] = {.patches = patches(*plane.paths, scenario_.reverberation.surface,
                                   pulse_.centre_frequency(), plane.tilt),
                .sectors = plane.sectors};
  });
  return found;
}

PingRecord PingSimulator::simulate(int ping) const {
  Stopwatch watch;
  const PingSchedule& schedule = scenario_.pings;
  const double ping_time = (ping - 1) * schedule.interval;
  const Transmitter projector = transmitter(ping);

  PingRecord record;
  record.ping = ping;
  record.start_time = ping_time;
  record.elevation = projector.elevation;
  record.platform = scenario_.platform.at(ping_time);
  for (const Target& target : scenario_.targets)
    record.targets.push_back(target.track.at(ping_time));
  for (const Vec3& phone : scenario_.array.phones)
    record.phones.push_back(record.platform.position + scenario_.array.offset + phone);
  record.recording = {.sample_rate = schedule.sample_rate,
                      .start = schedule.recording_start,
                      .samples = static_cast<std::size_t>(
                          std::llround(schedule.recording_duration * schedule.sample_rate))};

  const double local_speed = paths_.speed_at(record.platform.position);
  const BeamPattern pattern(projector, local_speed / pulse_.centre_frequency());

  // Echoes: source → target × target → array.
  Returns echo_returns;
  const EchoContext echo_context{.paths = paths_,
                                 .scenario = scenario_,
                                 .pattern = pattern,
                                 .frequency = pulse_.centre_frequency(),
                                 .ping_time = ping_time};
  for (std::size_t i = 0; i < scenario_.targets.size(); ++i) {
    const Target& target = scenario_.targets[i];
    if (ping < target.first_ping || ping > target.last_ping) continue;
    TargetEchoes found = target_echoes(echo_context, static_cast<int>(i));
    for (Leg& leg : found.legs) record.legs.push_back(std::move(leg));
    for (const EchoPath& echo : found.echoes) {
      echo_returns.push_back(echo.heard);
      record.echoes.push_back(echo);
    }
  }
  record.timings.eigenrays = watch.lap();

  // Reverberation: source → patch → array.
  const ReverberationContext reverberation{
      .scenario = scenario_,
      .pattern = pattern,
      .platform = record.platform,
      .sound_speed = local_speed,
      .ping = static_cast<std::uint32_t>(ping),
      .first_bearing = paths_.layered() ? 0.0 : scenario_.transect.bearing};
  std::vector<SectorPatches> rings;
  Returns patch_returns;
  if (scenario_.reverberation.enabled) {
    rings = surface_patches(record.platform.position, record.timings);
    patch_returns = reverberation_returns(reverberation, rings);
    record.patches = patch_rows(reverberation, rings, most_patch_rows).rows;
  }
  record.timings.patches = watch.lap() - record.timings.rays;

  // Time series.
  const double peak_pressure = std::numbers::sqrt2 * amplitude_from_db(projector.source_level_db) *
                               micropascal;  // at 1 m [Pa]
  record.pressure.assign(scenario_.array.phones.size() * record.recording.samples, 0.0F);
  const Synthesizer synthesizer(pulse_, record.recording, max_doppler_);
  LevelMeter levels(record.recording);
  Baseband heard = synthesizer.baseband(echo_returns, scenario_.array.phones);
  levels.add_echo(heard, peak_pressure);
  {
    const Baseband reverberated = synthesizer.baseband(patch_returns, scenario_.array.phones);
    levels.add_reverberation(reverberated, peak_pressure);
    std::transform(heard.values.begin(), heard.values.end(), reverberated.values.begin(),
                   heard.values.begin(), std::plus<>{});
  }
  synthesizer.add_passband(heard, peak_pressure, record.pressure);
  record.timings.synthesis = watch.lap();

  double noise_variance = 0.0;
  if (scenario_.noise.spectral_level_db) {
    add_white_noise(record.pressure, scenario_.array.phones.size(),
                    *scenario_.noise.spectral_level_db, schedule.sample_rate, scenario_.seed,
                    static_cast<std::uint32_t>(ping));
    noise_variance = white_noise_variance(*scenario_.noise.spectral_level_db, schedule.sample_rate);
  }
  levels.add_noise(noise_variance);
  record.levels = levels.series();
  record.summary = summarise(record, scenario_, pulse_, [&](double t) {
    return expected_reverberation_db(reverberation, rings, pulse_, t);
  });
  record.timings.noise = watch.lap();
  return record;
}

int run_pings(const PingSimulator& simulator, const std::function<void(PingRecord&&)>& sink,
              const PingOptions& options) {
  const int count = simulator.scenario().pings.count;
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
