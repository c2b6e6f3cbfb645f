#include "asdic/process.h"

#include <algorithm>
#include <cmath>

#include "io/processing/process_pings.h"
#include "io/processing/recordings.h"
#include "io/scenario/scenario_reader.h"
#include "library/ping_access.h"
#include "library/watched.h"
#include "processing/received_pings.h"
#include "processing/truth.h"
#include "sonar/scenario/sampling.h"
#include "sonar/signal/pulse.h"

namespace asdic {
namespace {

/// Pings that are at hand, as a receiver receives them.
class PingsAtHand final : public detail::ReceivedPings {
 public:
  explicit PingsAtHand(const std::vector<Ping>& pings) : pings_(pings) {
    if (pings.empty()) throw InputError("pings", "none", "one or more");
    const Scenario::Data& data = Access::data(pings.front().scenario());
    scenario_ = detail::scenario_of(data.document, data.path);
    for (const Ping& ping : pings) check(ping);
  }

  [[nodiscard]] const detail::Scenario& scenario() const noexcept override { return scenario_; }
  [[nodiscard]] std::size_t pings() const noexcept override { return pings_.size(); }
  [[nodiscard]] std::size_t row_of(int number) const override {
    const auto at = std::find_if(pings_.begin(), pings_.end(),
                                 [&](const Ping& ping) { return ping.number() == number; });
    if (at == pings_.end()) throw InputError("ping", std::to_string(number), "one of the pings");
    return static_cast<std::size_t>(at - pings_.begin());
  }
  [[nodiscard]] double ping_time(std::size_t row) const noexcept override {
    return pings_[row].time();
  }
  [[nodiscard]] int transmitter(std::size_t row) const noexcept override {
    return pings_[row].transmitter();
  }
  [[nodiscard]] double end(std::size_t row) const override {
    const Ping& ping = pings_[row];
    return ping.start() + static_cast<double>(ping.samples()) / ping.sample_rate();
  }
  [[nodiscard]] detail::ArrayRecording recording(std::size_t row, int array) const override;
  [[nodiscard]] std::size_t not_finite() const noexcept override { return 0; }
  [[nodiscard]] std::vector<detail::TrueEcho> echoes(std::size_t row, int array) const override {
    return PingAccess::data(pings_[row]).truth[static_cast<std::size_t>(array)];
  }
  [[nodiscard]] std::vector<detail::TrueTarget> targets(
      std::size_t row, const std::vector<detail::TrueEcho>& echoes) const override {
    return detail::true_targets(scenario_, pings_[row].number(), ping_time(row), echoes);
  }

  /// [transmitters] what each sends, as a file would tell it.
  [[nodiscard]] std::vector<detail::Replica> replicas() const;

 private:
  void check(const Ping& ping) const {
    if (ping.scenario().to_toml() != pings_.front().scenario().to_toml())
      throw InputError("pings", "pings of several scenarios", "those of one");
    if (scenario_.pings.continuous && !PingAccess::data(ping).from_file)
      throw InputError("pings", "a ping of a continuous record",
                       "one that was read from a file of all pings: read_ping()");
  }

  const std::vector<Ping>& pings_;
  detail::Scenario scenario_;
};

detail::ArrayRecording PingsAtHand::recording(std::size_t row, int array) const {
  const detail::PingRecord& record = PingAccess::data(pings_[row]).record;
  const std::size_t first = detail::first_channel(scenario_, array),
                    phones = scenario_.arrays[static_cast<std::size_t>(array)].phones.size();
  detail::ArrayRecording result{.ping = record.ping,
                                .transmitter = record.transmitter,
                                .array = array,
                                .ping_time = record.start_time,
                                .start = record.recording.start,
                                .sample_rate = record.recording.sample_rate};
  for (std::size_t n = 0; n < phones; ++n) {
    result.phones.push_back(record.phones[first + n]);
    const std::span<const float> samples = pings_[row].channel(first + n);
    if (record.recording.is_complex())
      for (std::size_t i = 0; i + 1 < samples.size(); i += 2)
        result.envelope.emplace_back(samples[i], samples[i + 1]);
    else
      result.pressure.insert(result.pressure.end(), samples.begin(), samples.end());
  }
  if (record.recording.is_complex()) result.carrier = record.recording.carrier;
  return result;
}

std::vector<detail::Replica> PingsAtHand::replicas() const {
  const double rate = detail::recorded_rate(scenario_),
               carrier = detail::recorded_carrier(scenario_);
  std::vector<detail::Replica> result;
  for (std::size_t t = 0; t < scenario_.transmitters.size(); ++t) {
    const detail::Pulse pulse(detail::pulse_of(scenario_, static_cast<int>(t)));
    if (carrier > 0.0) {
      const std::vector<float> samples = detail::baseband_replica(pulse, rate, carrier);
      std::vector<std::complex<float>> envelope;
      for (std::size_t i = 0; i + 1 < samples.size(); i += 2)
        envelope.emplace_back(samples[i], samples[i + 1]);
      result.emplace_back(std::span<const std::complex<float>>(envelope), rate, carrier);
    } else {
      const std::vector<float> samples = detail::replica(pulse, rate);
      result.emplace_back(std::span<const float>(samples), rate);
    }
  }
  return result;
}

detail::ProcessingSettings settings_of(const Receiving& asked, bool continuous,
                                       const std::vector<detail::Replica>& replicas) {
  detail::ProcessingSettings s;
  s.max_speed = asked.max_speed;
  s.target_depth = asked.target_depth;
  s.range_speed = asked.range_speed;
  detail::DetectorSettings& detector = s.detector;
  detector.beamformer = asked.mvdr ? detail::Beamformer::mvdr : detail::Beamformer::conventional;
  detector.shading = asked.hann_shading ? detail::Shading::hann : detail::Shading::none;
  detector.normaliser = {.method = asked.split_window ? detail::Normaliser::split_window
                                                      : detail::Normaliser::cell_averaging,
                         .guard_cells = asked.guard_cells,
                         .reference_cells = asked.reference_cells,
                         .false_alarm_probability = asked.false_alarm_probability,
                         .across_beams = asked.across_beams};
  double longest = 0.0;
  for (const detail::Replica& replica : replicas) longest = std::max(longest, replica.duration());
  detector.first_time = asked.from;
  if (!asked.from && !continuous) detector.first_time = longest;
  detector.last_time = asked.until;
  detector.sub_bands = asked.sub_bands;
  if (asked.cancel_direct_blast)
    s.cancel_direct_blast =
        *asked.cancel_direct_blast ? detail::BlastCancelling::on : detail::BlastCancelling::off;
  return s;
}

Detection shown(const detail::Detection& found, int owner, const detail::EarthPlaces& earth) {
  Detection result{.ping = found.ping,
                   .array = found.array,
                   .time = found.time,
                   .doppler = found.doppler,
                   .look_bearing = found.bearing,
                   .look_elevation = found.elevation,
                   .snr_db = found.snr_db,
                   .excess_db = found.excess_db,
                   .level_db = found.level_db,
                   .target = owner};
  for (const detail::Location& place : found.locations) {
    const auto there = std::isnan(place.bearing) ? detail::EarthPlaces().at(0.0, 0.0)
                                                 : earth.at(place.position.x(), place.position.y());
    result.places.push_back(
        {.position = {place.position.x(), place.position.y(), place.position.z()},
         .range = place.range,
         .bearing = place.bearing,
         .range_rate = place.range_rate,
         .latitude_deg = there.latitude,
         .longitude_deg = there.longitude});
  }
  return result;
}

Track shown(const detail::ProcessedTrack& made, const detail::EarthPlaces& earth) {
  Track result{.array = made.array, .ambiguous = made.ambiguous, .target = made.target};
  for (std::size_t i = 0; i < made.track.points.size(); ++i) {
    const detail::TrackPoint& point = made.track.points[i];
    const auto there = made.has_bearing ? earth.at(point.position.x(), point.position.y())
                                        : detail::EarthPlaces().at(0.0, 0.0);
    result.points.push_back({.ping = point.ping,
                             .detection = made.rows[i],
                             .time = point.time,
                             .position = {point.position.x(), point.position.y()},
                             .velocity = {point.velocity.x(), point.velocity.y()},
                             .position_sigma = point.position_sigma,
                             .latitude_deg = there.latitude,
                             .longitude_deg = there.longitude});
  }
  return result;
}

Processed processed(const detail::ReceivedPings& pings, std::vector<detail::Replica> replicas,
                    const Receiving& receiving, const Watch& watch) {
  const detail::ProcessingSettings settings =
      settings_of(receiving, pings.scenario().pings.continuous, replicas);
  const detail::PingProcessor processor(pings.scenario(), std::move(replicas), settings);
  const detail::ProcessedRun run = detail::process_pings(
      pings, processor, {},
      [&](int done) {
        if (watch.progress) watch.progress(done, static_cast<int>(pings.pings()));
      },
      [&] { return !watch.stop.stop_requested(); });
  Processed result{.warnings = run.warnings, .notes = run.notes, .on_earth = run.earth.known()};
  for (const detail::ProcessedPing& ping : run.pings)
    for (std::size_t i = 0; i < ping.array.result.detections.size(); ++i)
      result.detections.push_back(
          shown(ping.array.result.detections[i], ping.score.owner[i], run.earth));
  for (const detail::ProcessedTrack& track : run.tracks)
    result.tracks.push_back(shown(track, run.earth));
  return result;
}

}  // namespace

Processed process(const std::filesystem::path& file, const Receiving& receiving,
                  const Watch& watch) {
  return watched(watch,
                 [&] {
                   const detail::PingRecordings recordings(file);
                   return processed(recordings, recordings.replicas(), receiving, watch);
                 },
                 {file});
}

Processed process(const std::vector<Ping>& pings, const Receiving& receiving, const Watch& watch) {
  return watched(watch, [&] {
    const PingsAtHand received(pings);
    return processed(received, received.replicas(), receiving, watch);
  });
}

Processed process(const Ping& ping, const Receiving& receiving, const Watch& watch) {
  return process(std::vector<Ping>{ping}, receiving, watch);
}

}  // namespace asdic
