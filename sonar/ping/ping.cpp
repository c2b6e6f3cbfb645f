#include "sonar/ping/ping.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/huge_pages.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/warnings/warnings.h"
#include "raytrace/waves/put_roughness.h"
#include "reverb/power/reverberation_streams.h"
#include "sonar/echoes/direct_blast.h"
#include "sonar/echoes/echo.h"
#include "sonar/echoes/leg_response.h"
#include "sonar/echoes/peak_of_echoes.h"
#include "sonar/echoes/sparse_sound.h"
#include "sonar/echoes/two_step_echo.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/ping/levels.h"
#include "sonar/ping/ping_memory.h"
#include "sonar/ping/stopwatch.h"
#include "sonar/reverberation/reverberation_band.h"
#include "sonar/reverberation/reverberation_covariance.h"
#include "sonar/reverberation/reverberation_model.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmitter.h"
#include "sonar/synthesis/sound_synthesis.h"
#include "sonar/synthesis/synthesis_bytes.h"
#include "sonar/warnings/wave_warnings.h"

namespace asdic::detail {
namespace {

/// Of what a projector sends, at 1 m [Pa].
double peak_pressure_of(const Transmitter& projector) {
  return std::numbers::sqrt2 * amplitude_from_db(projector.source_level_db) * micropascal;
}

constexpr std::size_t most_patch_rows = 2000;

std::shared_ptr<const PropagationPaths> paths_of(const Scenario& scenario,
                                                 SharedPropagation* shared, bool& known) {
  const int dimension = scenario.propagation.dimension;
  if (shared != nullptr)
    return shared->paths(scenario.environment, scenario.transect, scenario.area, &known, dimension);
  return std::make_shared<const PropagationPaths>(
      scenario.environment, scenario.transect, scenario.area, nullptr,
      volume_of(scenario.environment, scenario.transect, scenario.area, dimension));
}

double end_of(const Recording& recording) {
  return recording.start + static_cast<double>(recording.samples) / recording.sample_rate;
}

/// Memory of echoes by many paths: a sound at the target, and what is received of it, in a period
/// of three records, before and after the transform.
MemoryNeed two_step_need(std::size_t channels, double samples) {
  return {
      .where = "pings.recording_duration",
      .what = "echoes by very many paths on " + std::to_string(channels) + " phones",
      .bytes = 6.0 * (static_cast<double>(channels) + 4.0) * samples * sizeof(std::complex<float>),
      .remedy =
          "a shorter record, fewer phones or numbers in propagation.max_surface_bounces and "
          "max_bottom_bounces"};
}

/// Memory of the sum of echoes that are received across the band part by part.
MemoryNeed band_need(const Synthesizer& synthesizer, std::size_t channels) {
  return {.where = "propagation.band",
          .what = "echoes across the band on " + std::to_string(channels) + " phones",
          .bytes = static_cast<double>(channels) * synthesis_bytes(synthesizer, channels).row,
          .remedy = "propagation.band = \"narrow\", fewer phones or a shorter record"};
}

}  // namespace

PingSimulator::PingSimulator(Scenario scenario, const std::shared_ptr<SharedPropagation>& shared,
                             MemoryBudget budget)
    : scenario_(std::move(scenario)),
      budget_(std::move(budget)),
      transmissions_(asdic::detail::transmissions(scenario_)),
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
int PingSimulator::reverberation_planes() const { return reverberation_->planes(); }

PingRecord PingSimulator::blank_record(const PingGeometry& geometry) const {
  const Transmission& sent = geometry.sent();
  const PingSchedule& schedule = scenario_.pings;
  PingRecord record;
  record.reuse = {.ocean = known_ocean_,
                  .reverberation = scenario_.reverberation.enabled,
                  .expected_level = scenario_.reverberation.enabled};
  record.ping = geometry.ping();
  record.transmitter = sent.transmitter;
  record.start_time = sent.time;
  record.elevation = sent.elevation;
  record.platform = geometry.source();
  for (int t = 0; t < static_cast<int>(scenario_.targets.size()); ++t)
    record.targets.push_back(geometry.target_at(t, 0.0));
  for (int a = 0; a < static_cast<int>(scenario_.arrays.size()); ++a)
    for (const Vec3& phone : geometry.phones(a))
      record.phones.push_back(geometry.reference_place(a).position + phone);
  record.recording = recording_of(scenario_);
  if (schedule.continuous) record.recording.epoch = sent.time;
  return record;
}

/// The part of a recording in which a target's many echoes are received; without samples where it
/// holds none of them. All of it where boundaries scatter, because how late that comes is drawn.
static Recording around(const ManyEchoes& many, const EchoContext& context, const Pulse& pulse,
                        const Recording& whole) {
  if (is_rough(context.scenario().environment)) return whole;
  constexpr double slowest = 1000.0;  // [m/s]
  double aperture = 0.0;              // of phones and highlights, there and back [m]
  for (const Vec3& x : context.geometry.phones(context.array))
    aperture = std::max(aperture, x.norm());
  double body = 0.0;
  for (const Highlight& one :
       context.scenario().targets[static_cast<std::size_t>(many.target)].highlights)
    body = std::max(body, one.offset.norm());
  const double margin = (aperture + 2.0 * body) / slowest + delay_of_response(pulse) + 0.1 +
                        0.1 * (many.last - many.first + pulse.duration());
  const auto sample = [&](double time) {
    const double n = std::floor((time - whole.start) * whole.sample_rate);
    return static_cast<std::size_t>(std::clamp(n, 0.0, static_cast<double>(whole.samples)));
  };
  const std::size_t begin = sample(many.first - margin),
                    end = sample(many.last + pulse.duration() + margin);
  Recording part = whole;
  part.start += static_cast<double>(begin) / whole.sample_rate;
  part.samples = end - begin;
  return part;
}

/// Echoes, source → target × target → array, and the ping itself on its way to the array.
PingSimulator::SparseReturns PingSimulator::sparse_returns(const EchoContext& context,
                                                           const Emission& emission,
                                                           PingRecord& record) const {
  SparseReturns returns;
  std::vector<EchoPath>& received = returns.paths;
  for (std::size_t i = 0; i < scenario_.targets.size(); ++i) {
    const Target& target = scenario_.targets[i];
    if (record.ping < target.first_ping || record.ping > target.last_ping) continue;
    TargetEchoes found = target_echoes(context, static_cast<int>(i));
    record.bounces.include(found.bounces);
    if (found.many) {
      const Recording part = around(*found.many, context, emission.pulse, record.recording);
      if (part.samples > 0) {
        MemoryBudget left = budget_;  // what is received is counted once its length is known
        const double rate = std::min(part.sample_rate, 4.0 * emission.pulse.bandwidth_40db());
        left.take(two_step_need(context.listens ? context.geometry.phones(context.array).size() : 1,
                                rate * static_cast<double>(part.samples) / part.sample_rate));
        const TwoStepBand band = band_of(context, emission, record, found.echoes, found.many->last);
        TwoStepSound sound = two_step_sound(context, *found.many, part, max_doppler_, band);
        found.many->peak = sound.peak;
        if (sound.received.channels > 0) returns.many.push_back(std::move(sound.received));
      }
      record.many_echoes.push_back(*found.many);
      record.echoes.insert(record.echoes.end(), found.echoes.begin(), found.echoes.end());
      found.echoes.clear();
    }
    for (Leg& leg : found.legs) record.legs.push_back(std::move(leg));
    for (const EchoPath& echo : found.echoes) {
      if (found.at_phones.empty()) received.push_back(echo);
      record.echoes.push_back(echo);
    }
    received.insert(received.end(), found.at_phones.begin(), found.at_phones.end());
    received.insert(received.end(), found.scattered.begin(), found.scattered.end());
    record.scattered.insert(record.scattered.end(), found.scattered.begin(), found.scattered.end());
  }
  const bool own = context.geometry.is_own(context.array);
  if (own ? scenario_.propagation.fathometer : scenario_.propagation.direct_blast) {
    DirectBlast blast = direct_blast(context);
    record.bounces.include(blast.bounces);
    for (Leg& leg : blast.legs) record.legs.push_back(std::move(leg));
    received.insert(received.end(), blast.received.begin(), blast.received.end());
  }
  return returns;
}

TwoStepBand PingSimulator::band_of(const EchoContext& context, const Emission& emission,
                                   const PingRecord& record, std::span<const EchoPath> loudest,
                                   double last) const {
  if (!across_the_band(context, emission.projector, loudest)) return {};
  return two_step_band(context, emission.projector, loudest,
                       1.1 * paths_->speed_at(record.platform.position) * last, record.recording,
                       max_doppler_);
}

double PingSimulator::peak_of(const Emission& emission, int array, std::span<const EchoPath> echoes,
                              PingRecord& record) const {
  if (echoes.empty()) return 0.0;
  const Recording recording = recording_of(scenario_);
  const EchoContext context = echo_context(emission, array, record);
  if (!across_the_band(context, emission.projector, echoes))
    return peak_of_echoes(emission.pulse, echoes,
                          recorded_pulse(emission.pulse, recording, max_doppler_));
  return peak_of_wide_band(context, emission.projector, echoes, recording, max_doppler_);
}

PingSimulator::Emission PingSimulator::emit(const Transmission& sent, int ping) const {
  PingGeometry geometry(scenario_, sent, ping);
  Transmitter projector = projector_of(scenario_, sent);
  const Pulse& sent_pulse = pulse(sent.transmitter);
  const double frequency = sent_pulse.centre_frequency();
  const double local_speed = paths_->speed_at(geometry.source().position);
  BeamPattern pattern(projector, local_speed / frequency, local_speed, geometry.source_heading());
  return {std::move(geometry), std::move(projector), sent_pulse, std::move(pattern)};
}

EchoContext PingSimulator::echo_context(const Emission& emission, int array,
                                        PingRecord& record) const {
  return {.paths = *paths_,
          .geometry = emission.geometry,
          .pattern = emission.pattern,
          .frequency = emission.pulse.centre_frequency(),
          .array = array,
          .pulse = &emission.pulse,
          .reuse = &record.reuse};
}

/// Reverberation: source → scatterer → array.
ReverberationContext PingSimulator::reverberation_context(const Emission& emission, int array,
                                                          PingRecord& record,
                                                          std::span<const Vec3> phones,
                                                          std::span<const BandPoint> band,
                                                          MemoryBudget* budget) const {
  return {.geometry = emission.geometry,
          .pattern = emission.pattern,
          .pulse = emission.pulse,
          .array = array,
          .latest = latest_,  // whatever part of the record is made
          .reuse = &record.reuse,
          .phones = phones,
          .band = band,
          .budget = budget,
          .drifts = true,
          .received_once = one_ping_ && scenario_.arrays.size() == 1};
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
PhoneGroups PingSimulator::plane_wave_fit(const Emission& emission, int array) const {
  return one_group(listening(emission.geometry, array), front_of_reverberation(emission, array),
                   emission.geometry.reverberation_point(array, emission.pulse.centre_frequency()));
}

Front PingSimulator::front_of_reverberation(const Emission& emission, int array) const {
  return nearest_reverberation(
      emission.geometry, array, emission.pulse.duration(),
      emission.pulse.centre_frequency() + 0.5 * emission.pulse.bandwidth_40db());
}

/// The parts of an array that receive reverberation by themselves: every phone where that is asked
/// for, else those that plane waves fit. Where its covariance or sectors are drawn, all receive it
/// together; streams are spheres; and groups grid no more returns than are allowed one by one.
PhoneGroups PingSimulator::reverberation_groups(const Emission& emission, int array,
                                                PhoneGroups whole,
                                                const PingReverberation& received) const {
  if (received.fields().empty()) return {};
  const Listening here = listening(emission.geometry, array);
  const Front front = front_of_reverberation(emission, array);
  if (scenario_.propagation.exact_per_phone) return phone_groups(here, front, infinity, 0.0);
  if (received.streams() != nullptr && received.covariance() == nullptr && received.blocks() == 0)
    whole.error = 0.0;
  if (received.covariance() != nullptr || !(received.one_by_one() > 0.0) ||
      whole.error <= reverberation_periods)
    return whole;
  const auto most = static_cast<double>(scenario_.reverberation.most_returns);
  return phone_groups(here, front, most / received.one_by_one());
}

/// Reverberation as groups of phones receive it where they are, from the same scatterers.
Baseband PingSimulator::sea_of_groups(const Synthesizer& synthesizer, const Emission& emission,
                                      int array, PingRecord& record, const PhoneGroups& groups,
                                      std::span<const BandPoint> band,
                                      const MemoryBudget& budget) const {
  Baseband all;
  for (const PhoneRange& part : groups.parts) {
    MemoryBudget own = budget;
    ReverberationContext context = reverberation_context(emission, array, record, {}, band, &own);
    context.point = emission.geometry.middle_of(array, part);
    const std::vector<Vec3> phones = emission.geometry.phones_from(*context.point, array);
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
  const Emission emission = emit(transmission(ping), ping);
  PingRecord record = blank_record(emission.geometry);
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    EchoContext context = echo_context(emission, static_cast<int>(a), record);
    context.listens = false;
    sparse_returns(context, emission, record);
  }
  record.timings.eigenrays = watch.lap();
  std::map<int, PingReverberation> received;  // by array, where an echo is strongest
  const auto peak = [&](int array, std::span<const EchoPath> echoes) {
    return peak_of(emission, array, echoes, record);
  };
  const auto reverberation_db = [&](int array, double time) {
    auto at = received.find(array);
    if (at == received.end()) {
      MemoryBudget budget = budget_;
      ReverberationContext context =
          reverberation_context(emission, array, record, {}, {}, &budget);
      context.level_alone = true;
      at = received.emplace(array, reverberation_->ping(context)).first;
    }
    record.bounces.include(at->second.bounces());
    return at->second.expected_db(time);
  };
  record.summary = summarise(record, scenario_, emission.pulse, {peak, reverberation_db});
  record.timings.rays = watch.lap();
  record.ended_searches = paths_->memory().ended_searches();
  return record;
}

PingRecord PingSimulator::sound(int ping, const Transmission& sent, const ChoosePart& part,
                                const HeardPart& heard) const {
  Stopwatch watch;
  at_step(ping, 0.0, "paths to targets");
  paths_->memory().next_ping();
  const Emission emission = emit(sent, ping);
  const PingGeometry& geometry = emission.geometry;
  PingRecord record = blank_record(geometry);
  MemoryBudget budget = budget_;
  budget.take(record_need(scenario_, most_samples()));
  std::vector<SparseSound> sparse;                // [arrays]
  std::vector<std::vector<Baseband>> many_paths;  // [arrays][targets of very many paths]
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    const EchoContext context = echo_context(emission, static_cast<int>(a), record);
    SparseReturns returns = sparse_returns(context, emission, record);
    sparse.push_back(by_band(context, emission.projector, std::move(returns.paths)));
    many_paths.push_back(std::move(returns.many));
    for (const Baseband& sound : many_paths.back())
      budget.take(two_step_need(sound.channels, static_cast<double>(sound.samples)));
  }
  const double longest = 2.0 * emission.pulse.duration() + 1.0;  // of what a return sounds [s]
  const auto unheard = [&](const EchoPath& echo) {
    return !heard.meets(echo.received.delay - 1.0, echo.received.delay + longest);
  };
  bool wide = false;  // whether any echo is received across the band
  for (SparseSound& of_array : sparse) {
    wide = wide || !of_array.wide.empty();
    std::erase_if(of_array.narrow, unheard);
    std::erase_if(of_array.wide, unheard);
  }
  if (part) {
    const SampleRange wanted = part(record);
    record.recording.start += static_cast<double>(wanted.first) / record.recording.sample_rate;
    record.recording.samples = wanted.count;
  }
  record.timings.eigenrays = watch.lap();
  const double peak_pressure = peak_pressure_of(emission.projector);
  const Synthesizer synthesizer(emission.pulse, record.recording, max_doppler_, paths_->memory());
  std::optional<ReverberationBand> band;
  std::optional<Synthesizer> filtered;
  if (scenario_.propagation.band == BandOfLosses::wide && scenario_.reverberation.enabled) {
    band.emplace(scenario_, *paths_, reverberation_->laws(), emission.projector, record.platform,
                 geometry.source_heading(), emission.pulse.centre_frequency(),
                 synthesizer.half_band(), end_of(record.recording));
    filtered.emplace(emission.pulse, record.recording, max_doppler_, band->filters());
    record.band = {static_cast<int>(band->points().size()), band->reached()};
  }
  budget.take(synthesis_need(filtered ? *filtered : synthesizer));
  if (scenario_.propagation.band == BandOfLosses::automatic && wide)
    budget.take(band_need(synthesizer, channels_of(scenario_)));
  const std::size_t samples =
      record.phones.size() * record.recording.samples * record.recording.components();
  record.pressure.reserve(samples);
  prefer_huge_pages(record.pressure.data(), samples * sizeof(float));
  for (std::size_t silent = 0; silent < samples;) {  // gigabytes take seconds
    stop_point();
    silent = std::min(samples, silent + (std::size_t{1} << 24));
    record.pressure.resize(silent);
  }
  record.timings.synthesis = watch.lap();

  // The reverberation's samples of the last ping of this thread, if few: memory that the system
  // takes back and gives again costs more than what a ping of a study puts into it.
  thread_local std::vector<std::complex<float>> used_before;
  constexpr std::size_t few = std::size_t{1} << 19;
  LevelMeter levels(record.recording, emission.pulse.duration());
  Baseband received, reverberated;           // of all channels
  std::vector<PingReverberation> scattered;  // [arrays]
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    const int array = static_cast<int>(a);
    const auto step = [&](double share, std::string_view doing) {  // the loop is 0.1 to 0.9 of all
      at_step(ping, 0.1 + 0.8 * (double(a) + share) / double(scenario_.arrays.size()), doing);
    };
    step(0.0, "echoes");
    const std::vector<Vec3>& phones = geometry.phones(array);
    const EchoContext context = echo_context(emission, array, record);
    Baseband of_array;
    if (!sparse[a].narrow.empty() || sparse[a].wide.empty())
      of_array = narrow_band_sound(synthesizer, sparse[a].narrow, phones);
    if (!sparse[a].wide.empty())
      of_array = wide_band_sound(context, emission.projector, sparse[a].wide, phones,
                                 record.recording, max_doppler_, std::move(of_array));
    for (const Baseband& sound : many_paths[a]) add_resampled(sound, of_array);
    many_paths[a].clear();
    append_channels(received, std::move(of_array));
    record.timings.synthesis += watch.lap();
    step(0.25, "what the sea sends back");
    const auto points = band ? band->points() : std::span<const BandPoint>();
    const std::vector<Vec3> around = geometry.phones_from(
        geometry.reverberation_point(array, emission.pulse.centre_frequency()), array);
    const PhoneGroups whole = plane_wave_fit(emission, array);
    const bool plane = whole.error <= reverberation_periods;
    // A line that bends while it listens has phones with velocities of their own.
    const bool drawn =
        !scenario_.propagation.exact_per_phone && (plane || !geometry.motion(array).deforms());
    scattered.push_back(reverberation(
        emission, array, record, drawn ? std::span<const Vec3>(around) : std::span<const Vec3>(),
        points, budget, plane));
    record.bounces.include(scattered.back().bounces());
    record.sea_drawn_anew = record.sea_drawn_anew || scattered.back().drawn_anew();
    record.timings.rays += watch.lap();
    if (a == 0) record.patches = scattered.back().rows(most_patch_rows, &paths_->memory()).rows;
    record.timings.patches += watch.lap();
    step(0.5, "reverberation at the phones");
    if (scenario_.reverberation.enabled) {
      levels.add_reverberation(scattered.back(), peak_pressure,
                               double(phones.size()) / double(record.phones.size()),
                               paths_->memory());
      const Synthesizer& voice = filtered ? *filtered : synthesizer;
      const PhoneGroups groups = reverberation_groups(emission, array, whole, scattered.back());
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
      const CovarianceDraw draw{
          .seed = scenario_.seed,
          .ping = static_cast<std::uint32_t>(ping),
          .lasting = ~static_cast<std::uint32_t>(emission.geometry.sent().transmitter)};
      if (dense != nullptr) synthesizer.add_gaussian(*dense, draw, sea);
      if (streams != nullptr) synthesizer.add_streams(*streams, around, draw, sea, heard);
      append_channels(reverberated, std::move(sea));
    }
    record.timings.synthesis += watch.lap();
  }
  at_step(ping, 0.9, "levels and noise");
  levels.add_echo(received, peak_pressure);
  if (reverberated.samples == received.samples)
    std::transform(reverberated.values.begin(), reverberated.values.end(), received.values.begin(),
                   received.values.begin(), std::plus<>{});
  else if (reverberated.channels > 0) {  // on a grid of its own
    receivers_.respond(reverberated);
    synthesizer.add_samples(reverberated, peak_pressure, record.pressure);
  }
  if (reverberated.values.size() <= few) used_before = std::move(reverberated.values);
  receivers_.respond(received);
  synthesizer.add_samples(received, peak_pressure, record.pressure);
  record.timings.synthesis += watch.lap();

  levels.add_noise(noise_.recorded_power());
  record.levels = levels.series();
  record.summary =
      summarise(record, scenario_, emission.pulse,
                {.peak =
                     [&](int array, std::span<const EchoPath> echoes) {
                       return peak_of(emission, array, echoes, record);
                     },
                 .reverberation_db =
                     [&](int array, double time) {
                       return scattered[static_cast<std::size_t>(array)].expected_db(time);
                     }});
  record.timings.noise = watch.lap();
  record.ended_searches = paths_->memory().ended_searches();
  return record;
}

PingSimulator::MeanSea PingSimulator::mean_sea(int ping, int array) const {
  const auto refuse = [](const char* where, const char* got, const char* expected) {
    throw InputError({.where = where, .got = got, .expected = expected});
  };
  if (!receivers_.is_flat())
    refuse("array.electronics", "receivers with a response of their own", "what is summed without");
  if (scenario_.pings.continuous || scenario_.pings.blanking)
    refuse("pings", "a stream, or blanking", "pings by themselves, to sum what they receive");
  if (scenario_.propagation.band == BandOfLosses::wide)
    refuse("propagation.band", "\"wide\"", "one amplitude for the band, to sum reverberation");
  if (!scenario_.interferers.empty())
    refuse("interferer", "ships that are heard", "none, to sum what is received");
  const Emission emission = emit(transmission(ping), ping);
  const PingGeometry& geometry = emission.geometry;
  if (geometry.motion(array).deforms())
    refuse("array", "phones that move against one another while they listen",
           "a shape that stays, to sum what it receives");
  MeanSea sea{.streams = std::make_shared<const ReverberationStreams>(),
              .phones = geometry.phones_from(
                  geometry.reverberation_point(array, emission.pulse.centre_frequency()), array),
              .peak_pressure = peak_pressure_of(emission.projector)};
  if (!scenario_.reverberation.enabled) return sea;
  PingRecord record = blank_record(geometry);
  MemoryBudget budget = budget_;
  sea.streams = reverberation_->as_streams(
      reverberation_context(emission, array, record, sea.phones, {}, &budget));
  if (sea.streams == nullptr)
    refuse("reverberation", "scatterers with a texture, or weights that last",
           "a sea that every ping draws anew, to sum it");
  return sea;
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

// What bounds on paths and one amplitude for a band leave out of a scenario's sound.

Bounces PingSimulator::judged_echoes(const PingGeometry& geometry, int array) const {
  const double frequency = pulse(geometry.sent().transmitter).centre_frequency();
  const Vec3 &source = geometry.source().position,
             &receiver = geometry.reference_place(array).position;
  const auto judged = [&](const Vec3& from, const Vec3& to) {
    return enough_bounces(*paths_, scenario_.propagation, from, to, frequency,
                          end_of_record(scenario_), true);
  };
  Bounces all;
  for (int t = 0; t < static_cast<int>(scenario_.targets.size()); ++t) {
    const Vec3 place = geometry.target_at(t, 0.0).position;
    Bounces legs = judged(source, place);
    const Bounces back = judged(place, receiver);
    const double both = legs.left_out_db + back.left_out_db;
    legs.include(back);
    legs.left_out_db = both;
    all.include(legs);
  }
  return all;
}

Bounces PingSimulator::judged_reverberation(const Emission& emission, int array) const {
  PingRecord record = blank_record(emission.geometry);
  MemoryBudget budget = budget_;
  ReverberationContext context = reverberation_context(emission, array, record, {}, {}, &budget);
  context.judged = true;
  return reverberation_->bounces(context);
}

PingSimulator::JudgedPaths PingSimulator::judge_paths() {
  Bounces echoes, reverberated;
  JudgedPaths judged;
  for (int t = 0; t < static_cast<int>(scenario_.transmitters.size()); ++t) {
    const auto first = std::find_if(transmissions_.begin(), transmissions_.end(),
                                    [&](const Transmission& s) { return s.transmitter == t; });
    if (first == transmissions_.end()) continue;
    const Emission emission = emit(*first, 1);
    for (int a = 0; a < static_cast<int>(scenario_.arrays.size()); ++a) {
      echoes.include(judged_echoes(emission.geometry, a));
      for (std::string& text : wave_warnings(emission.geometry, *paths_, pulse(t), a))
        add_warnings({std::move(text)}, judged.warnings);
      if (scenario_.reverberation.enabled) reverberated.include(judged_reverberation(emission, a));
    }
  }
  judged.followed.include(reverberated);
  add_warnings({lacking(scenario_.propagation, echoes, "an echo"),
                lacking(scenario_.propagation, reverberated, "reverberation"),
                ended_early(paths_->memory().ended_searches())},
               judged.warnings);
  judged.followed.include(echoes);
  add_warnings(judged.warnings, scenario_.notes);
  return judged;
}

// What a record gets that does not come of a ping.

/// Noise and ships at the phones in samples first … of a record that may lie outside of it.
std::vector<float> PingSimulator::surroundings(const PingRecord& record, std::int64_t first,
                                               std::int64_t samples) const {
  PingRecord part;
  part.ping = record.ping;
  part.start_time = record.start_time;
  part.recording = record.recording;
  part.recording.samples = static_cast<std::size_t>(samples);
  part.phones = record.phones;
  part.pressure.assign(part.phones.size() * part.recording.samples * part.recording.components(),
                       0.0F);
  interference_.add(part.samples(), first);
  noise_.add(part.samples(), first);
  return std::move(part.pressure);
}

void PingSimulator::complete(PingRecord& record) const {
  Stopwatch watch;
  if (receivers_.is_flat()) {
    record.interference = interference_.add(record.samples());
    noise_.add(record.samples());
  } else {  // the sound of the ping has passed the receivers; this has to as well
    std::vector<float> received =
        std::exchange(record.pressure, std::vector<float>(record.pressure.size(), 0.0F));
    const auto ahead = static_cast<std::int64_t>(receivers_.ahead(record.recording));
    ReceiverElectronics::Carried carried = surroundings(record, -ahead, 2 * ahead);
    record.interference = interference_.add(record.samples(), ahead);
    noise_.add(record.samples(), ahead);
    receivers_.respond(record.pressure, record.recording, carried);
    std::transform(received.begin(), received.end(), record.pressure.begin(),
                   record.pressure.begin(), std::plus<>{});
  }
  if (scenario_.pings.blanking) {  // while this ping leaves: its record receives no other
    const Recording& recording = record.recording;
    const auto sample = [&](double since) {  // the first one from then on
      return static_cast<std::size_t>(
          std::ceil(std::clamp((since - recording.start) * recording.sample_rate, 0.0,
                               static_cast<double>(recording.samples))));
    };
    const auto& sender = scenario_.transmitters[static_cast<std::size_t>(record.transmitter)];
    blank(sender.platform, record.pressure, sample(0.0),
          sample(pulse(record.transmitter).duration()));
  }
  receivers_.convert(record.pressure, record.recording);
  record.timings.noise += watch.lap();
}

void PingSimulator::blank(int platform, std::span<float> samples, std::size_t begin,
                          std::size_t end) const {
  const std::size_t width = recording_of(scenario_).components(),
                    row = samples.size() / channels_of(scenario_);
  for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
    if (scenario_.arrays[a].platform != platform) continue;
    const std::size_t first = first_channel(scenario_, static_cast<int>(a));
    for (std::size_t n = 0; n < scenario_.arrays[a].phones.size(); ++n) {
      const std::span<float> channel = samples.subspan((first + n) * row, row);
      std::fill(channel.begin() + static_cast<std::ptrdiff_t>(begin * width),
                channel.begin() + static_cast<std::ptrdiff_t>(end * width), 0.0F);
    }
  }
}

// What a stream has around its pings.

namespace {

/// A record that is a part of a stream.
PingRecord part_of_stream(const Scenario& scenario, const PingSimulator::StreamPart& part) {
  PingRecord record;
  record.ping = part.ping;
  record.recording = recording_of(scenario);
  record.recording.start = 0.0;
  record.recording.samples = part.samples;
  record.start_time = static_cast<double>(part.first) / record.recording.sample_rate;
  record.phones.resize(channels_of(scenario));
  record.pressure.assign(record.phones.size() * part.samples * record.recording.components(), 0.0F);
  return record;
}

}  // namespace

std::vector<float> PingSimulator::surroundings(const StreamPart& part,
                                               ReceiverElectronics::Carried& carried) const {
  PingRecord record = part_of_stream(scenario_, part);
  const auto ahead = static_cast<std::int64_t>(receivers_.ahead(record.recording));
  if (!receivers_.is_flat() && carried.empty()) carried = surroundings(record, -ahead, 2 * ahead);
  interference_.add(record.samples(), ahead);
  noise_.add(record.samples(), ahead);
  if (!receivers_.is_flat()) receivers_.respond(record.pressure, record.recording, carried);
  return std::move(record.pressure);
}

std::vector<ReceivedPath> PingSimulator::ships(const StreamPart& part) const {
  PingRecord record = part_of_stream(
      scenario_, {.ping = part.ping, .first = part.first, .samples = part.samples > 0 ? 1U : 0U});
  return interference_.add(record.samples());
}

void PingSimulator::convert(std::span<float> samples, std::size_t row) const {
  Recording recording = recording_of(scenario_);
  recording.samples = row;
  receivers_.convert(samples, recording);
}

}  // namespace asdic::detail
