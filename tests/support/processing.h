#pragma once
#include <vector>

#include "processing/ping_processor.h"
#include "processing/scoring.h"
#include "processing/truth.h"
#include "sonar/ping/ping.h"
#include "sonar/ping/run_pings.h"

namespace asdic::detail::support {

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

inline std::vector<Replica> replicas_of(const PingSimulator& simulator) {
  std::vector<Replica> replicas;
  const double rate = simulator.scenario().pings.sample_rate;
  for (std::size_t t = 0; t < simulator.scenario().transmitters.size(); ++t)
    replicas.emplace_back(std::span<const float>(replica(simulator.pulse(int(t)), rate)), rate);
  return replicas;
}

/// Tracks of the contacts of all pings at their first array. \param side  of its axis: 0 the right
inline std::vector<ContactTrack> tracks_of(const PingSimulator& simulator,
                                           const ProcessingSettings& settings, int side = 0) {
  const PingProcessor processor(simulator.scenario(), replicas_of(simulator), settings);
  std::vector<std::vector<Contact>> contacts;
  std::vector<double> times;
  run_pings(simulator, [&](PingRecord&& record) {
    const ProcessedArray done = processor.process(recording_of(simulator.scenario(), record));
    contacts.push_back(processor.contacts(done, record.start_time, side));
    times.push_back(record.start_time);
  });
  return track_contacts(contacts, times, settings.tracker);
}

}  // namespace asdic::detail::support
