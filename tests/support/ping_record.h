#pragma once
#include <cmath>

#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping_record.h"

namespace asdic::detail::support {

/// A small sea with a target: isovelocity, four phones.
inline Scenario small_scenario(const std::vector<std::string>& overrides = {}) {
  return parse_scenario(R"(title = "small"
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 5000.0
kind = "fluid"
[platform]
position = [0.0, 0.0, 1000.0]
[transmitter]
source_level_db = 220.0
beamwidth_deg = 6.0
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 4
spacing = 0.5
[[target]]
name = "one, and only"
position = [3000.0, 0.0, 1000.0]
strength_db = 15.0
[pings]
recording_duration = 0.5
sample_rate = 4000.0
)",
                        "small.toml", overrides);
}

/// A record of the right shape with recognisable numbers in it.
inline PingRecord small_record(const Scenario& scenario, int ping) {
  PingRecord record;
  record.ping = ping;
  record.start_time = (ping - 1) * scenario.pings.interval;
  record.elevation = radians(8.0);
  record.platform = scenario.platforms[0].track.at(record.start_time);
  for (const Target& target : scenario.targets)
    record.targets.push_back(target.track.at(record.start_time));
  for (const Vec3& phone : scenario.arrays[0].phones)
    record.phones.push_back(record.platform.position + scenario.arrays[0].offset + phone);
  record.recording = {.sample_rate = scenario.pings.sample_rate,
                      .start = scenario.pings.recording_start,
                      .samples = static_cast<std::size_t>(std::lround(
                          scenario.pings.recording_duration * scenario.pings.sample_rate))};
  record.pressure.resize(record.phones.size() * record.recording.samples);
  for (std::size_t i = 0; i < record.pressure.size(); ++i)
    record.pressure[i] = static_cast<float>(ping) + 1e-6F * static_cast<float>(i % 1000003);
  Arrival direct{.launch_elevation = radians(5.0),
                 .arrival_elevation = radians(-5.0),
                 .delay = 2.0,
                 .amplitude = {0.6e-3, -0.8e-3},
                 .spreading = 1e-3,
                 .absorption_db = 0.1,
                 .path_length = 3000.0,
                 .bounces = {}};
  Arrival bounced = direct;
  bounced.surface_bounces = 1;
  bounced.bounces = {{BoundaryKind::surface, radians(30.0), 1500.0}};
  record.legs.push_back({.kind = Leg::Kind::source_to_target,
                         .target = 0,
                         .bearing = radians(90.0),
                         .range = 3000.0,
                         .arrivals = {direct, bounced}});
  EchoPath echo{.target = 0, .outgoing = 0, .returning = 1, .level_db = 90.0, .received = {}};
  echo.received.delay = 4.0;
  echo.received.doppler = 1.001;
  echo.received.slowness = Vec3(-std::cos(radians(5.0)), 0.0, std::sin(radians(5.0))) / 1500.0;
  record.echoes.push_back(echo);
  for (int i = 0; i < 4500; ++i)
    record.patches.push_back(
        {.ground = static_cast<PatchRow::Ground>(i / 1500), .range = 1000.0 + i, .level_db = 70.0});
  record.levels = {.time_step = 0.05,
                   .echo = std::vector<float>(10, 1.0F),
                   .reverberation = std::vector<float>(10, 2.0F),
                   .noise = std::vector<float>(10, 3.0F)};
  record.summary.push_back({.name = scenario.targets[0].name,
                            .present = true,
                            .paths = 4,
                            .echo_time = 4.0,
                            .echo_level_db = 90.0,
                            .reverberation_db = 60.0,
                            .noise_db = 50.0,
                            .echo_peak_db = 91.0,
                            .signal_excess_db = 29.6});
  return record;
}

}  // namespace asdic::detail::support
