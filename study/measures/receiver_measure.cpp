#include "study/measures/receiver_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/truth.h"
#include "sonar/signal/pulse.h"
#include "study/plan/no_value.h"

namespace asdic::detail::study {

ArrayRecording array_recording(const Scenario& scenario, const PingRecord& record, int array) {
  const Recording& r = record.recording;
  const std::size_t first = first_channel(scenario, array);
  const std::size_t phones = scenario.arrays[static_cast<std::size_t>(array)].phones.size();
  ArrayRecording made{.ping = record.ping,
                      .transmitter = record.transmitter,
                      .array = array,
                      .ping_time = record.start_time,
                      .start = r.start,
                      .sample_rate = r.sample_rate};
  for (std::size_t n = 0; n < phones; ++n) made.phones.push_back(record.phones[first + n]);
  const float* samples = record.pressure.data() + first * r.samples * r.components();
  if (!r.is_complex()) {
    made.pressure.assign(samples, samples + phones * r.samples);
    return made;
  }
  made.carrier = r.carrier;
  for (std::size_t i = 0; i < phones * r.samples; ++i)
    made.envelope.emplace_back(samples[2 * i], samples[2 * i + 1]);
  return made;
}

namespace {

/// What is sent, as a file would hold it.
std::vector<Replica> replicas_of(const PingSimulator& simulator, const Recording& recording) {
  std::vector<Replica> made;
  for (std::size_t t = 0; t < simulator.scenario().transmitters.size(); ++t) {
    const Pulse& pulse = simulator.pulse(static_cast<int>(t));
    if (!recording.is_complex()) {
      made.emplace_back(replica(pulse, recording.sample_rate), recording.sample_rate);
      continue;
    }
    const std::vector<float> parts =
        baseband_replica(pulse, recording.sample_rate, recording.carrier);
    std::vector<std::complex<float>> envelope;
    for (std::size_t i = 0; i < parts.size(); i += 2) envelope.emplace_back(parts[i], parts[i + 1]);
    made.emplace_back(envelope, recording.sample_rate, recording.carrier);
  }
  return made;
}

}  // namespace

ReceiverAnswers receiver_answers(const PingSimulator& simulator, const PingRecord& record,
                                 const ProcessingSettings& settings, int array) {
  const Scenario& scenario = simulator.scenario();
  const Recording& recording = record.recording;
  ProcessingSettings chosen = settings;
  if (chosen.detector.first_time.value_or(0.0) <= 0.0)  // not while it transmits
    chosen.detector.first_time = recording.start + simulator.pulse(record.transmitter).duration();
  const PingProcessor processor(scenario, replicas_of(simulator, recording), chosen);
  ProcessedArray processed = processor.process(array_recording(scenario, record, array));
  const std::vector<TrueEcho> echoes = true_echoes(record, array);
  const double end =
      recording.start + static_cast<double>(recording.samples) / recording.sample_rate;
  PingScore score = score_detections(processed.result.detections, echoes,
                                     true_targets(scenario, record.ping, record.start_time, echoes),
                                     processed.shape, processed.places.array,
                                     processor.resolution(processed), *chosen.detector.first_time,
                                     std::min(chosen.detector.last_time.value_or(end), end));
  ReceiverAnswers answers;
  answers.false_alarms = score.false_alarms;
  answers.of_noise = expected_alarms(processed.result).most;
  for (const TargetScore& target : score.targets) {
    ReceiverAnswer answer{.hit = target.hit,
                          .snr_db = no_value,
                          .position_error = no_value,
                          .range_error = no_value,
                          .bearing_error = no_value,
                          .error = target.error,
                          .from_array = target.from_array};
    if (target.hit) {
      answer.snr_db =
          processed.result.detections[static_cast<std::size_t>(target.detection)].snr_db;
      answer.position_error = target.position_error;
      answer.range_error = target.range_error;
      answer.bearing_error = target.bearing_error;
    }
    answers.targets.push_back(answer);
  }
  answers.places = tracked_ping(processor, processed, record.start_time, std::move(score.owner));
  answers.detections = std::move(processed.result.detections);
  return answers;
}

}  // namespace asdic::detail::study
