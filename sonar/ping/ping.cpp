#include "sonar/ping/ping.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/huge_pages.h"
#include "sonar/echoes/direct_blast.h"
#include "sonar/echoes/echo.h"
#include "sonar/echoes/sparse_sound.h"
#include "sonar/echoes/two_step_echo.h"
#include "sonar/ping/levels.h"
#include "sonar/ping/ping_memory.h"
#include "sonar/ping/stopwatch.h"
#include "sonar/reverberation/ground_grid.h"
#include "sonar/reverberation/reverberation.h"
#include "sonar/reverberation/reverberation_band.h"
#include "sonar/reverberation/reverberation_covariance.h"
#include "sonar/reverberation/reverberation_streams.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmitter.h"
#include "sonar/synthesis/sound_synthesis.h"

namespace asdic {
namespace {

constexpr std::size_t most_patch_rows = 2000;

std::shared_ptr<const PropagationPaths> paths_of(const Scenario& scenario,
                                                 SharedPropagation* shared, bool& known) {
  if (shared != nullptr) return shared->paths(scenario.environment, scenario.transect, &known);
  return std::make_shared<const PropagationPaths>(scenario.environment, scenario.transect);
}

double end_of(const Recording& recording) {
  return recording.start + static_cast<double>(recording.samples) / recording.sample_rate;
}

/// Of echoes by many paths: a sound as long as the record at the target, and what is heard of it,
/// in a period of three records, before and after the transform.
MemoryNeed two_step_need(const ManyEchoes& many, const Baseband& heard) {
  return {.where = "pings.recording_duration",
          .what = "echoes by " + std::to_string(many.pairs) + " pairs of paths on " +
                  std::to_string(heard.channels) + " phones",
          .bytes = 6.0 * static_cast<double>(heard.values.size() + 4 * heard.samples) *
                   sizeof(std::complex<float>),
          .remedy =
              "a shorter record, fewer phones or numbers in propagation.max_surface_bounces and "
              "max_bottom_bounces"};
}

}  // namespace

PingSimulator::PingSimulator(Scenario scenario, const std::shared_ptr<SharedPropagation>& shared,
                             MemoryBudget budget)
    : scenario_(std::move(scenario)),
      budget_(std::move(budget)),
      transmissions_(asdic::transmissions(scenario_)),
      paths_(paths_of(scenario_, shared.get(), known_ocean_)),
      noise_(scenario_, *paths_),
      interference_(scenario_, *paths_),
      receivers_(scenario_),
      max_doppler_(doppler_bound(scenario_)) {
  for (std::size_t t = 0; t < scenario_.transmitters.size(); ++t)
    pulses_.emplace_back(pulse_of(scenario_, static_cast<int>(t)));
  const auto wider = [](const Pulse& a, const Pulse& b) {
    return a.bandwidth_99() < b.bandwidth_99();
  };
  reverberation_ = std::make_unique<ReverberationModel>(
      scenario_, *paths_, *std::max_element(pulses_.begin(), pulses_.end(), wider));
  latest_ = end_of(recording_of(scenario_));
  set_sea(scenario_.reverberation.surface, scenario_.wind_speed,
          speed_at_surface(scenario_, *paths_));
}

Transmitter PingSimulator::transmitter(int ping) const {
  return projector_of(scenario_, transmission(ping));
}

double PingSimulator::ground_spacing() const { return reverberation_->ground_spacing(); }

PingRecord PingSimulator::blank_record(int ping, const Transmission& sent) const {
  const PingSchedule& schedule = scenario_.pings;
  PingRecord record;
  record.reuse = {.ocean = known_ocean_,
                  .reverberation = scenario_.reverberation.enabled,
                  .expected_level = scenario_.reverberation.enabled};
  record.ping = ping;
  record.transmitter = sent.transmitter;
  record.start_time = sent.time;
  record.elevation = sent.elevation;
  record.platform = transmitter_at(scenario_, sent.transmitter, sent.time);
  for (const Target& target : scenario_.targets)
    record.targets.push_back(target.track.at(sent.time));
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    const Vec3 reference = array_at(scenario_, static_cast<int>(a), sent.time).position;
    for (const Vec3& phone : phones_at(scenario_, static_cast<int>(a), ping, sent.time))
      record.phones.push_back(reference + phone);
  }
  record.recording = recording_of(scenario_);
  if (schedule.continuous) record.recording.epoch = sent.time;
  return record;
}

/// Echoes, source → target × target → array, and the ping itself on its way to the array.
std::vector<EchoPath> PingSimulator::sparse_returns(const EchoContext& context,
                                                    PingRecord& record) const {
  std::vector<EchoPath> heard;
  for (std::size_t i = 0; i < scenario_.targets.size(); ++i) {
    const Target& target = scenario_.targets[i];
    if (record.ping < target.first_ping || record.ping > target.last_ping) continue;
    TargetEchoes found = target_echoes(context, static_cast<int>(i));
    record.bounces.include(found.bounces);
    if (found.many) {
      found.many->peak = two_step_peak(context, *found.many, record.recording, max_doppler_);
      record.many_echoes.push_back(*found.many);
      record.echoes.insert(record.echoes.end(), found.echoes.begin(), found.echoes.end());
      found.echoes.clear();
    }
    for (Leg& leg : found.legs) record.legs.push_back(std::move(leg));
    for (const EchoPath& echo : found.echoes) {
      if (found.at_phones.empty()) heard.push_back(echo);
      record.echoes.push_back(echo);
    }
    heard.insert(heard.end(), found.at_phones.begin(), found.at_phones.end());
    heard.insert(heard.end(), found.scattered.begin(), found.scattered.end());
    record.scattered.insert(record.scattered.end(), found.scattered.begin(), found.scattered.end());
  }
  const auto platform_of = [](const auto& list, int i) {
    return list[static_cast<std::size_t>(i)].platform;
  };
  const bool own = platform_of(scenario_.transmitters, context.transmitter) ==
                   platform_of(scenario_.arrays, context.array);
  if (own ? scenario_.propagation.fathometer : scenario_.propagation.direct_blast) {
    DirectBlast blast = direct_blast(context);
    record.bounces.include(blast.bounces);
    for (Leg& leg : blast.legs) record.legs.push_back(std::move(leg));
    heard.insert(heard.end(), blast.heard.begin(), blast.heard.end());
  }
  return heard;
}

/// Of the targets whose pairs of paths are too many to be laid down one by one.
void PingSimulator::add_many_echoes(const EchoContext& context, const Emission& emission,
                                    std::span<const Vec3> phones, const PingRecord& record,
                                    Baseband& heard) const {
  for (const ManyEchoes& many : record.many_echoes) {
    if (many.array != context.array) continue;
    std::vector<BandPart> band;
    if (scenario_.propagation.wide_band) {
      const PulseBand of_pulse(context, emission.projector, record.recording, max_doppler_);
      const double longest = 1.1 * paths_->speed_at(record.platform.position) * many.last;
      const BandNodes nodes = of_pulse.nodes(longest);
      for (std::size_t k = 0; k < nodes.frequencies.size(); ++k)
        band.push_back(of_pulse.part(nodes, k));
    }
    const Baseband more = two_step_echo(context, many, {phones, many.at_phones}, record.recording,
                                        max_doppler_, band);
    if (more.channels > 0) add_resampled(more, heard);
  }
}

PingSimulator::Emission PingSimulator::emit(const Transmission& sent) const {
  Transmitter projector = projector_of(scenario_, sent);
  const Pulse& sent_pulse = pulse(sent.transmitter);
  const double frequency = sent_pulse.centre_frequency();
  const double local_speed =
      paths_->speed_at(transmitter_at(scenario_, sent.transmitter, sent.time).position);
  const double heading = platform_heading(scenario_, projector.platform, sent.time);
  BeamPattern pattern(projector, local_speed / frequency, local_speed, heading);
  return {sent, std::move(projector), sent_pulse, std::move(pattern)};
}

EchoContext PingSimulator::echo_context(const Emission& emission, int array,
                                        PingRecord& record) const {
  return {.paths = *paths_,
          .scenario = scenario_,
          .pattern = emission.pattern,
          .frequency = emission.pulse.centre_frequency(),
          .ping_time = emission.sent.time,
          .transmitter = emission.sent.transmitter,
          .array = array,
          .ping = record.ping,
          .turn = emission.sent.turn,
          .pulse = &emission.pulse,
          .reuse = &record.reuse};
}

/// Reverberation: source → scatterer → array.
ReverberationContext PingSimulator::reverberation_context(const Emission& emission, int array,
                                                          PingRecord& record,
                                                          std::span<const Vec3> phones,
                                                          std::span<const BandPoint> band,
                                                          MemoryBudget* budget) const {
  return {.pattern = emission.pattern,
          .pulse = emission.pulse,
          .transmitter = emission.sent.transmitter,
          .array = array,
          .time = emission.sent.time,
          .ping = static_cast<std::uint32_t>(record.ping),
          .latest = latest_,  // whatever part of the record is made
          .reuse = &record.reuse,
          .phones = phones,
          .band = band,
          .budget = budget,
          .drifts = true,
          .heard_once = one_ping_ && scenario_.arrays.size() == 1};
}

PingReverberation PingSimulator::reverberation(const Emission& emission, int array,
                                               PingRecord& record, std::span<const Vec3> phones,
                                               std::span<const BandPoint> band, MemoryBudget budget,
                                               bool plane_waves) const {
  ReverberationContext context =
      reverberation_context(emission, array, record, phones, band, &budget);
  context.plane_waves = plane_waves;
  return reverberation_->ping(context);
}

/// The whole array, with what plane waves of reverberation would be wrong at its worst phone.
PhoneGroups PingSimulator::plane_wave_fit(const Emission& emission, int array,
                                          const PingRecord& record) const {
  const Listening here{
      .scenario = scenario_, .array = array, .ping = record.ping, .ping_time = emission.sent.time};
  return one_group(here, front_of_reverberation(here, emission),
                   reverberation_point(scenario_, emission.sent.transmitter, array, here.ping_time,
                                       emission.pulse.centre_frequency()));
}

Front PingSimulator::front_of_reverberation(const Listening& here, const Emission& emission) const {
  return nearest_reverberation(
      here, emission.sent.transmitter, emission.pulse.duration(),
      emission.pulse.centre_frequency() + 0.5 * emission.pulse.bandwidth_40db());
}

/// The parts of an array that hear reverberation by themselves: every phone where that is asked
/// for, else those that plane waves fit. Where its covariance or sectors are drawn, all hear it
/// together; streams are spheres; and groups lay down no more returns than are allowed one by one.
PhoneGroups PingSimulator::reverberation_groups(const Emission& emission, int array,
                                                const PingRecord& record, PhoneGroups whole,
                                                const PingReverberation& heard) const {
  if (heard.fields().empty()) return {};
  const Listening here{
      .scenario = scenario_, .array = array, .ping = record.ping, .ping_time = emission.sent.time};
  const Front front = front_of_reverberation(here, emission);
  if (scenario_.propagation.exact_per_phone) return phone_groups(here, front, infinity, 0.0);
  if (heard.streams() != nullptr && heard.covariance() == nullptr && heard.blocks() == 0)
    whole.error = 0.0;
  if (heard.covariance() != nullptr || !(heard.one_by_one() > 0.0) ||
      whole.error <= reverberation_periods)
    return whole;
  const auto most = static_cast<double>(scenario_.reverberation.most_returns);
  return phone_groups(here, front, most / heard.one_by_one());
}

/// Reverberation as groups of phones hear it where they are, from the same scatterers.
Baseband PingSimulator::sea_of_groups(const Synthesizer& synthesizer, const Emission& emission,
                                      int array, PingRecord& record, const PhoneGroups& groups,
                                      std::span<const BandPoint> band,
                                      const MemoryBudget& budget) const {
  Baseband all;
  for (const PhoneRange& part : groups.parts) {
    MemoryBudget own = budget;
    ReverberationContext context = reverberation_context(emission, array, record, {}, band, &own);
    context.point = middle_of(scenario_, array, record.ping, part);
    const std::vector<Vec3> phones =
        phones_from(*context.point, scenario_, array, record.ping, emission.sent.time);
    const PingReverberation sea = reverberation_->ping(context);
    append_channels(all, sea.blocks() > 0 ? synthesizer.baseband(sea, std::span(phones).subspan(
                                                                          part.first, part.count))
                                          : synthesizer.silence(part.count));
  }
  return all;
}

PingRecord PingSimulator::levels(int ping) const {
  Stopwatch watch;
  paths_->memory().next_ping();
  const Emission emission = emit(transmission(ping));
  PingRecord record = blank_record(ping, emission.sent);
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    EchoContext context = echo_context(emission, static_cast<int>(a), record);
    context.listens = false;
    sparse_returns(context, record);
  }
  record.timings.eigenrays = watch.lap();
  std::map<int, PingReverberation> heard;  // by array, where an echo is strongest
  record.summary = summarise(record, scenario_, emission.pulse, [&](int array, double time) {
    auto at = heard.find(array);
    if (at == heard.end()) {
      MemoryBudget budget = budget_;
      ReverberationContext context =
          reverberation_context(emission, array, record, {}, {}, &budget);
      context.level_alone = true;
      at = heard.emplace(array, reverberation_->ping(context)).first;
    }
    record.bounces.include(at->second.bounces());
    return at->second.expected_db(time);
  });
  record.timings.rays = watch.lap();
  return record;
}

PingRecord PingSimulator::sound(int ping, const Transmission& sent, const ChoosePart& part) const {
  Stopwatch watch;
  paths_->memory().next_ping();
  const Emission emission = emit(sent);
  PingRecord record = blank_record(ping, sent);
  MemoryBudget budget = budget_;
  budget.take(record_need(scenario_, most_samples()));
  std::vector<std::vector<EchoPath>> sparse;  // [arrays]
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a)
    sparse.push_back(sparse_returns(echo_context(emission, static_cast<int>(a), record), record));
  if (part) {
    const SampleRange wanted = part(record);
    record.recording.start += static_cast<double>(wanted.first) / record.recording.sample_rate;
    record.recording.samples = wanted.count;
  }
  record.timings.eigenrays = watch.lap();
  const double peak_pressure = std::numbers::sqrt2 *
                               amplitude_from_db(emission.projector.source_level_db) *
                               micropascal;  // at 1 m [Pa]
  const Synthesizer synthesizer(emission.pulse, record.recording, max_doppler_, paths_->memory());
  std::optional<ReverberationBand> band;
  std::optional<Synthesizer> coloured;
  if (scenario_.propagation.wide_band && scenario_.reverberation.enabled) {
    band.emplace(scenario_, *paths_, reverberation_->laws(), emission.projector, record.platform,
                 platform_heading(scenario_, emission.projector.platform, sent.time),
                 emission.pulse.centre_frequency(), synthesizer.half_band(),
                 end_of(record.recording));
    coloured.emplace(emission.pulse, record.recording, max_doppler_, band->filters());
    record.band = {static_cast<int>(band->points().size()), band->reached()};
  }
  budget.take(synthesis_need(coloured ? *coloured : synthesizer));
  const std::size_t samples =
      record.phones.size() * record.recording.samples * record.recording.components();
  record.pressure.reserve(samples);
  prefer_huge_pages(record.pressure.data(), samples * sizeof(float));
  record.pressure.assign(samples, 0.0F);
  record.timings.synthesis = watch.lap();

  // The reverberation's samples of the last ping of this thread, if few: memory that the system
  // takes back and gives again costs more than what a ping of a study puts into it.
  thread_local std::vector<std::complex<float>> used_before;
  constexpr std::size_t few = std::size_t{1} << 19;
  LevelMeter levels(record.recording);
  Baseband heard, reverberated;              // of all channels
  std::vector<PingReverberation> scattered;  // [arrays]
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    const int array = static_cast<int>(a);
    const std::vector<Vec3> phones = phones_at(scenario_, array, ping, sent.time);
    const EchoContext context = echo_context(emission, array, record);
    Baseband of_array = scenario_.propagation.wide_band
                            ? wide_band_sound(context, emission.projector, sparse[a], record.legs,
                                              phones, record.recording, max_doppler_)
                            : narrow_band_sound(synthesizer, sparse[a], phones);
    for (const ManyEchoes& many : record.many_echoes)
      if (many.array == array) budget.take(two_step_need(many, of_array));
    add_many_echoes(context, emission, phones, record, of_array);
    append_channels(heard, std::move(of_array));
    record.timings.synthesis += watch.lap();
    const auto points = band ? band->points() : std::span<const BandPoint>();
    const std::vector<Vec3> around =
        phones_from(reverberation_point(scenario_, sent.transmitter, array, sent.time,
                                        emission.pulse.centre_frequency()),
                    scenario_, array, ping, sent.time);
    const PhoneGroups whole = plane_wave_fit(emission, array, record);
    const bool plane = whole.error <= reverberation_periods;
    // A line that bends while it listens has phones with velocities of their own.
    const bool drawn =
        !scenario_.propagation.exact_per_phone && (plane || !deforms(scenario_, array));
    scattered.push_back(reverberation(
        emission, array, record, drawn ? std::span<const Vec3>(around) : std::span<const Vec3>(),
        points, budget, plane));
    record.bounces.include(scattered.back().bounces());
    record.timings.rays += watch.lap();
    if (a == 0) record.patches = scattered.back().rows(most_patch_rows, &paths_->memory()).rows;
    record.timings.patches += watch.lap();
    if (scenario_.reverberation.enabled) {
      const Synthesizer& voice = coloured ? *coloured : synthesizer;
      const PhoneGroups groups =
          reverberation_groups(emission, array, record, whole, scattered.back());
      record.plane_waves.groups =
          std::max(record.plane_waves.groups, static_cast<int>(groups.parts.size()));
      record.plane_waves.error = std::max(record.plane_waves.error, groups.error);
      if (groups.parts.size() > 1) {
        append_channels(reverberated,
                        sea_of_groups(voice, emission, array, record, groups, points, budget));
        record.timings.synthesis += watch.lap();
        continue;
      }
      const ReverberationCovariance* dense = scattered.back().covariance();
      const ReverberationStreams* streams = scattered.back().streams();
      Baseband sea = scattered.back().blocks() > 0 ? voice.baseband(scattered.back(), around)
                     : streams != nullptr
                         ? synthesizer.silence(*streams, phones.size(), std::move(used_before))
                     : dense != nullptr
                         ? synthesizer.silence(*dense, std::move(used_before))
                         : synthesizer.silence(phones.size(), std::move(used_before));
      const CovarianceDraw draw{.seed = scenario_.seed, .ping = static_cast<std::uint32_t>(ping)};
      if (dense != nullptr) synthesizer.add_gaussian(*dense, draw, sea);
      if (streams != nullptr) synthesizer.add_streams(*streams, around, draw, sea);
      append_channels(reverberated, std::move(sea));
    }
    record.timings.synthesis += watch.lap();
  }
  levels.add_echo(heard, peak_pressure);
  levels.add_reverberation(reverberated, peak_pressure);
  if (reverberated.samples == heard.samples)
    std::transform(reverberated.values.begin(), reverberated.values.end(), heard.values.begin(),
                   heard.values.begin(), std::plus<>{});
  else if (reverberated.channels > 0) {  // on a grid of its own
    receivers_.respond(reverberated);
    synthesizer.add_samples(reverberated, peak_pressure, record.pressure);
  }
  if (reverberated.values.size() <= few) used_before = std::move(reverberated.values);
  receivers_.respond(heard);
  synthesizer.add_samples(heard, peak_pressure, record.pressure);
  record.timings.synthesis += watch.lap();

  levels.add_noise(noise_.recorded_power());
  record.levels = levels.series();
  record.summary = summarise(record, scenario_, emission.pulse, [&](int array, double time) {
    return scattered[static_cast<std::size_t>(array)].expected_db(time);
  });
  record.timings.noise = watch.lap();
  return record;
}

PingRecord PingSimulator::simulate(int ping) const { return simulate(ping, transmission(ping)); }

PingRecord PingSimulator::simulate(int ping, const ChoosePart& part) const {
  const bool alike = receivers_.is_flat() && !scenario_.pings.continuous &&
                     !scenario_.pings.blanking && scenario_.noise.any();
  PingRecord record = sound(ping, transmission(ping), alike ? part : ChoosePart());
  complete(record);
  return record;
}

PingRecord PingSimulator::simulate(int ping, const Transmission& sent) const {
  PingRecord record = sound(ping, sent);
  complete(record);
  return record;
}

}  // namespace asdic
