#include "sonar/echoes/direct_blast.h"

#include <algorithm>

#include "reverb/scatterer_field.h"
#include "sonar/echoes/one_leg.h"
#include "sonar/paths/moving_paths.h"
#include "sonar/paths/plane_wave.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/sampling.h"

namespace asdic {
namespace {

/// The curve of a path's delay, where its Doppler factor changes during the pulse.
std::optional<DelayCurve> curve_of(const EchoContext& context, const Kinematics& source,
                                   const Carried& hearer, int channel, const MetPath& met,
                                   const Return& heard, const PathLimits& limits) {
  if (context.pulse == nullptr) return std::nullopt;
  const Scenario& scenario = context.scenario;
  const Pulse& pulse = *context.pulse;
  const double highest = pulse.centre_frequency() + 0.5 * pulse.bandwidth_40db();
  const Track& track = hearer.track;
  const Vec3& offset = hearer.offset;
  double aperture = 0.0;
  if (channel < 0)
    for (const Vec3& phone : phones_at(scenario, context.array, context.ping, context.ping_time))
      aperture = std::max(aperture, phone.norm());
  const MovingPaths closely(context.paths, limits, context.frequency, context.ping_time, 1e-9,
                            context.reuse);
  const auto moment = [&](double sent) -> std::optional<PulseMoment> {
    const Vec3 from =
        transmitter_at(scenario, context.transmitter, context.ping_time + sent).position;
    const Way way = closely.way(from, sent, track, offset, std::span(&met.path, 1));
    const Arrival* path = same_path(way.leg.arrivals, met.path, context.paths.layered());
    if (path == nullptr) return std::nullopt;
    const MetPath then = closely.meet(from, sent, track, offset, way, *path);
    return PulseMoment{
        .sent = sent,
        .struck = then.time,
        .heard = then.time,
        .at_array = met_by(then.way.end.velocity,
                           slowness_vector(then.way.leg.bearing, then.path.arrival_elevation,
                                           context.paths.speed_at(then.way.end.position)))};
  };
  const auto& transmitter = scenario.transmitters[static_cast<std::size_t>(context.transmitter)];
  const auto& carrier = scenario.platforms[static_cast<std::size_t>(transmitter.platform)];
  // Turns that the pulse can meet: it is nowhere longer than 1.5 T.
  const auto near = [&](std::vector<double> turns, double from) {
    std::erase_if(
        turns, [&](double turn) { return turn <= from || turn >= from + 1.5 * pulse.duration(); });
    return turns;
  };
  const MovingPath path{.moment = moment,
                        .pulse_duration = pulse.duration(),
                        .frequency = highest,
                        .source_turns = near(turns_of(carrier.track, context.ping_time), 0.0),
                        .target_turns = {},
                        .array_turns = near(turns_of(track, context.ping_time), met.time)};
  const double phase =
      curvature_phase(highest, pulse.duration(), (met.way.end.velocity - source.velocity).norm(),
                      met.path.path_length, context.paths.speed_at(source.position), aperture);
  if (phase < negligible_phase && path.source_turns.empty() && path.array_turns.empty())
    return std::nullopt;
  return delay_curve(pulse_moments(path), heard, Vec3::Zero(), highest, aperture);
}

/// The blast at one phone, or at the reference point for all of them.
void hear(const EchoContext& context, int channel, DirectBlast& blast) {
  const Scenario& scenario = context.scenario;
  const ReceiverArray& array = scenario.arrays[static_cast<std::size_t>(context.array)];
  const Carried hearer = channel < 0 ? reference_of(scenario, context.array)
                                     : phone_of(scenario, context.array, context.ping, channel);
  // Of the phone from the reference point, as it was at the ping: what its return is laid down by.
  const Vec3 x = channel < 0 ? Vec3::Zero()
                             : phones_at(scenario, context.array, context.ping,
                                         context.ping_time)[static_cast<std::size_t>(channel)];
  const Kinematics source = transmitter_at(scenario, context.transmitter, context.ping_time);
  const Bounces followed = enough_bounces(context.paths, scenario.propagation, source.position,
                                          hearer.at(context.ping_time).position, context.frequency,
                                          end_of_record(scenario));
  blast.bounces.include(followed);
  const PathLimits limits = limits_of(scenario.propagation, followed);
  const MovingPaths moving(context.paths, limits, context.frequency, context.ping_time, 1e-7,
                           context.reuse);
  Way way = moving.way(source.position, 0.0, hearer.track, hearer.offset);
  way.leg.kind = Leg::Kind::source_to_array;
  way.leg.array = context.array;
  way.leg.channel = channel;
  const auto& transmitter = scenario.transmitters[static_cast<std::size_t>(context.transmitter)];
  if (transmitter.platform == array.platform)
    std::erase_if(way.leg.arrivals, [](const Arrival& path) {
      return path.surface_bounces + path.bottom_bounces == 0;
    });
  for (const Arrival& path : way.leg.arrivals) {
    const MetPath met = moving.meet(source.position, 0.0, hearer.track, hearer.offset, way, path);
    EchoPath path_heard = heard_along(context, source, met);
    path_heard.heard.delay -= path_heard.heard.slowness.dot(x);  // at the reference point
    path_heard.heard.channel = channel < 0 ? Return::all_channels : channel;
    path_heard.curve = curve_of(context, source, hearer, channel, met, path_heard.heard, limits);
    blast.heard.push_back(path_heard);
    scatter_along(context, source, 0.0, met,
                  mixed(static_cast<std::uint64_t>(context.transmitter), ~0ULL), path_heard,
                  blast.heard);
  }
  shorten_bounces(way.leg.arrivals, channel < 0 ? 1 : array.phones.size());
  blast.legs.push_back(std::move(way.leg));
}

/// Whether all that is heard at the reference point is a plane wave to the phones.
bool plane_waves(const EchoContext& context, const DirectBlast& blast) {
  return std::all_of(blast.heard.begin(), blast.heard.end(), [&](const EchoPath& path) {
    return is_plane_wave(context, path.heard, path.colour.path_length);
  });
}

}  // namespace

DirectBlast direct_blast(const EchoContext& context) {
  DirectBlast blast;
  const Scenario& scenario = context.scenario;
  const auto phones = scenario.arrays[static_cast<std::size_t>(context.array)].phones.size();
  const auto hear_at_phones = [&](DirectBlast& into) {
    for (std::size_t n = 0; n < phones; ++n) hear(context, static_cast<int>(n), into);
  };
  if (scenario.propagation.exact_per_phone) {
    hear_at_phones(blast);
    return blast;
  }
  hear(context, -1, blast);
  if (context.listens && !plane_waves(context, blast)) {
    DirectBlast at_phones;
    hear_at_phones(at_phones);
    blast.heard = std::move(at_phones.heard);
  }
  return blast;
}

}  // namespace asdic
