// What a ping takes at its peak (PingSimulator::memory).
#include "sonar/ping/ping_memory.h"

#include <algorithm>
#include <cmath>

#include "sonar/ping/ping.h"
#include "sonar/ping/stream_parts.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/sampling.h"
#include "sonar/synthesis/synthesis_bytes.h"

namespace asdic::detail {

MemoryNeed record_need(const Scenario& scenario, double samples, const std::string& where) {
  const bool complex = scenario.pings.samples == Samples::baseband;
  const double copies = (ReceiverElectronics(scenario).is_flat() ? 1.0 : 3.0) +
                        (scenario.pings.continuous ? 1.0 : 0.0);
  const std::size_t phones = channels_of(scenario);
  return {.where = where,
          .what = std::to_string(std::llround(samples)) + " samples on " + std::to_string(phones) +
                  " phones",
          .bytes = copies * static_cast<double>(phones) * samples * sizeof(float) *
                   (complex ? 2.0 : 1.0),
          .remedy =
              "a shorter record, fewer phones, a lower sample rate or pings.samples = "
              "\"baseband\""};
}

/// Of a record, or of the longest part of a stream.
double PingSimulator::most_samples() const {
  const std::size_t own = recording_of(scenario_).samples;
  return static_cast<double>(
      scenario_.pings.continuous ? std::max(own, longest_stream_part(scenario_)) : own);
}

/// Echoes and reverberation in the band of the pulse.
MemoryNeed PingSimulator::synthesis_need(const Synthesizer& synthesizer) const {
  const std::size_t channels = channels_of(scenario_);
  const SynthesisBytes of_array = synthesis_bytes(synthesizer, channels);
  // Beside what one array's takes: the echoes of all, their reverberation, and across the band the
  // sum so far. Those of several arrays are put under one another.
  double rows = static_cast<double>(channels);
  if (!scenario_.reverberation.enabled) rows = 0.0;
  if (scenario_.propagation.band == BandOfLosses::wide) rows += static_cast<double>(channels);
  if (scenario_.arrays.size() > 1) rows += static_cast<double>(channels);
  return {.where = "pulse.duration",
          .what = "echoes and reverberation on " + std::to_string(channels) +
                  " phones in a band of " +
                  std::to_string(std::llround(2.0 * synthesizer.half_band())) + " Hz",
          .bytes = of_array.all + rows * of_array.row,
          .remedy =
              "a pulse with less bandwidth (longer, or with a window), fewer phones or a shorter "
              "record (pings.recording_duration)"};
}

MemoryBudget PingSimulator::memory(int ping) const {
  const Emission emission = emit(transmission(ping), ping);
  PingRecord record = blank_record(emission.geometry);
  MemoryBudget budget = budget_;
  budget.take(record_need(scenario_, most_samples()));
  budget.take(synthesis_need(
      Synthesizer(emission.pulse, record.recording, max_doppler_, paths_->memory())));
  if (!scenario_.reverberation.enabled) return budget;
  MemoryBudget largest = budget;  // of the arrays, which are received one after the other
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    MemoryBudget of_array = budget;
    const int array = static_cast<int>(a);
    const std::vector<Vec3> phones = emission.geometry.phones_from(
        emission.geometry.reverberation_point(array, emission.pulse.centre_frequency()), array);
    reverberation_->take_memory(
        reverberation_context(emission, array, record, phones, {}, &of_array));
    if (of_array.taken() > largest.taken()) largest = std::move(of_array);
  }
  return largest;
}

}  // namespace asdic::detail
