#pragma once
#include <vector>

#include "sonar/ping.h"
#include "sonar/processing/ping_processor.h"
#include "sonar/processing/scoring.h"

namespace asdic::support {

/// What one array of a simulated ping recorded, as a file would hold it.
inline ArrayRecording recording_of(const Scenario& scenario, const PingRecord& record,
                                   int array = 0) {
  const std::size_t first = first_channel(scenario, array),
                    phones = scenario.arrays[std::size_t(array)].phones.size(),
                    samples = record.recording.samples;
  ArrayRecording r{.ping = record.ping,
                   .transmitter = record.transmitter,
                   .array = array,
                   .ping_time = record.start_time,
                   .start = record.recording.start,
                   .sample_rate = record.recording.sample_rate};
  for (std::size_t n = 0; n < phones; ++n) r.phones.push_back(record.phones[first + n]);
  const auto begin = record.pressure.begin() + std::ptrdiff_t(first * samples);
  r.pressure.assign(begin, begin + std::ptrdiff_t(phones * samples));
  return r;
}

inline std::vector<TrueEcho> echoes_of(const PingRecord& record, int array = 0) {
  std::vector<TrueEcho> echoes;
  for (const EchoPath& e : record.echoes)
    if (e.array == array)
      echoes.push_back({.target = e.target,
                        .time = e.heard.delay,
                        .struck = e.struck,
                        .doppler = e.heard.doppler,
                        .level_db = e.level_db,
                        .travel = e.heard.slowness.normalized()});
  return echoes;
}

/// Where the targets were when the loudest of their echoes struck them.
inline std::vector<TrueTarget> targets_of(const Scenario& scenario, const PingRecord& record,
                                          const std::vector<TrueEcho>& echoes) {
  std::vector<TrueTarget> targets;
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    double loudest = -infinity, time = 0.0;
    for (const TrueEcho& e : echoes)
      if (e.target == int(i) && e.level_db > loudest) loudest = e.level_db, time = e.struck;
    targets.push_back(
        {.target = int(i),
         .name = scenario.targets[i].name,
         .present = true,
         .position = scenario.targets[i].track.at(record.start_time + time).position});
  }
  return targets;
}

inline std::vector<Replica> replicas_of(const PingSimulator& simulator) {
  std::vector<Replica> replicas;
  const double rate = simulator.scenario().pings.sample_rate;
  for (std::size_t t = 0; t < simulator.scenario().transmitters.size(); ++t)
    replicas.emplace_back(std::span<const float>(replica(simulator.pulse(int(t)), rate)), rate);
  return replicas;
}

}  // namespace asdic::support
