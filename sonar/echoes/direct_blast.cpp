#include "sonar/echoes/direct_blast.h"

#include <algorithm>
#include <span>

#include "core/doppler.h"
#include "core/mixed_bits.h"
#include "sonar/echoes/leg_response.h"
#include "sonar/echoes/one_leg.h"
#include "sonar/echoes/outer_phones.h"
#include "sonar/paths/moving_paths.h"
#include "sonar/paths/plane_wave.h"
#include "sonar/paths/wave_moments.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

/// The curve of a path's delay, where its Doppler factor changes during the pulse.
std::optional<DelayCurve> curve_of(const EchoContext& context, const Kinematics& source,
                                   const Carried& receiver, int channel, const MetPath& met,
                                   const Return& received, const PathLimits& limits) {
  if (context.pulse == nullptr) return std::nullopt;
  const PingGeometry& geometry = context.geometry;
  const Pulse& pulse = *context.pulse;
  const double highest = pulse.centre_frequency() + 0.5 * pulse.bandwidth_40db();
  const Track& track = receiver.track;
  const Vec3& offset = receiver.offset;
  double aperture = 0.0;
  if (channel < 0)
    for (const Vec3& phone : geometry.phones(context.array))
      aperture = std::max(aperture, phone.norm());
  const MovingPaths closely(context.paths, limits, context.frequency, geometry.time(), 1e-9,
                            context.reuse);
  const auto moment = [&](double sent) -> std::optional<PulseMoment> {
    const Vec3 from = geometry.source_at(sent).position;
    const Way way = closely.way(from, sent, track, offset, std::span(&met.path, 1));
    const Arrival* path = same_path(way.leg.arrivals, met.path, context.paths.layered());
    if (path == nullptr) return std::nullopt;
    const MetPath then = closely.meet(from, sent, track, offset, way, *path);
    return PulseMoment{
        .sent = sent,
        .struck = then.time,
        .received = then.time,
        .at_array = met_by(then.way.end.velocity,
                           arriving_slowness(then.way.leg.bearing, then.path,
                                             context.paths.speed_at(then.way.end.position)))};
  };
  // Turns that the pulse can meet: it is nowhere longer than 1.5 T.
  const auto near = [&](std::vector<double> course_changes, double from) {
    std::erase_if(course_changes, [&](double change) {
      return change <= from || change >= from + 1.5 * pulse.duration();
    });
    return course_changes;
  };
  const MovingPath path{
      .moment = moment,
      .pulse_duration = pulse.duration(),
      .frequency = highest,
      .source_course_changes =
          near(course_changes_of(geometry.sender().track, geometry.time()), 0.0),
      .target_course_changes = {},
      .array_course_changes = near(course_changes_of(track, geometry.time()), met.time)};
  const double phase =
      curvature_phase(highest, pulse.duration(), (met.way.end.velocity - source.velocity).norm(),
                      met.path.path_length, context.paths.speed_at(source.position), aperture);
  if (phase < negligible_phase && path.source_course_changes.empty() &&
      path.array_course_changes.empty())
    return std::nullopt;
  const bool by_waves = met.path.kind == ArrivalKind::diffracted;
  return delay_curve(by_waves ? wave_moments(path) : pulse_moments(path), received, Vec3::Zero(),
                     Vec3::Zero(), highest, aperture);
}

/// Adds the blast at one phone, or at the reference point for all of them.   \return place of the
/// receiver then
Vec3 receive(const EchoContext& context, int channel, DirectBlast& blast) {
  const PingGeometry& geometry = context.geometry;
  // Of the phone from the reference point, as it was at the ping: what its return is gridded by.
  const Vec3 x = channel < 0 ? Vec3(Vec3::Zero())
                             : geometry.phones(context.array)[static_cast<std::size_t>(channel)];
  const Kinematics& source = geometry.source();
  BlastPaths paths = blast_paths(context, channel);
  blast.bounces.include(paths.followed);
  std::shared_ptr<const MetLeg> leg;  // null: amplitudes of the centre serve
  if (context.listens && context.pulse != nullptr &&
      context.scenario().propagation.band != BandOfLosses::narrow)
    leg = std::make_shared<const MetLeg>(MetLeg{.from = source.position,
                                                .to = paths.end,
                                                .paths = paths.leg.arrivals,
                                                .frequency = context.frequency,
                                                .limits = paths.limits});
  SeaDraws draws(context.scenario().seed);
  for (std::size_t i = 0; i < paths.met.size(); ++i) {
    const MetPath& met = paths.met[i];
    const EchoPath path_received = received_along(context, source, met);
    const std::size_t own = blast.received.size();
    blast.received.push_back(path_received);
    scatter_along(context, source, 0.0, met,
                  mixed(static_cast<std::uint64_t>(geometry.sent().transmitter), ~0ULL),
                  path_received, draws, blast.received);
    for (EchoPath& one : std::span(blast.received).subspan(own)) {
      one.received.delay -= one.received.slowness.dot(x);  // at the reference point
      one.received.channel = channel < 0 ? Return::all_channels : channel;
    }
    blast.received[own].curve = curve_of(context, source, paths.receiver, channel, met,
                                         blast.received[own].received, paths.limits);
    if (leg != nullptr) blast.received[own].legs = {path_on_leg(leg, i, source.position, met)};
  }
  shorten_bounces(paths.leg.arrivals,
                  channel < 0 ? 1 : geometry.array(context.array).phones.size());
  blast.legs.push_back(std::move(paths.leg));
  return paths.end;
}

/// Whether every path at the reference point is a plane wave over the phones.   \param place
/// reference point when the first sound arrives [m]
bool plane_waves(const EchoContext& context, const DirectBlast& blast, const Vec3& place) {
  return std::all_of(blast.received.begin(), blast.received.end(),
                     [&](const EchoPath& path) {
                       return is_plane_wave(context, path.received, path.response.path_length);
                     }) &&
         is_alike_at_phones(context, {blast.legs.back(), place}, [&](int phone) -> ArrivedLeg {
           BlastPaths own = blast_paths(context, phone);
           return {std::move(own.leg), own.end};
         });
}

}  // namespace

BlastPaths blast_paths(const EchoContext& context, int channel) {
  const PingGeometry& geometry = context.geometry;
  const Scenario& scenario = context.scenario();
  const Vec3 from = geometry.source().position;
  BlastPaths found{.leg = {},
                   .met = {},
                   .end = {},
                   .receiver = geometry.receiver(context.array, channel),
                   .followed = {},
                   .limits = {}};
  const Carried& receiver = found.receiver;
  found.followed = enough_bounces(context.paths, scenario.propagation, from,
                                  receiver.at(geometry.time()).position, context.frequency,
                                  end_of_record(scenario));
  found.limits = limits_of(scenario.propagation, found.followed);
  const MovingPaths moving(context.paths, found.limits, context.frequency, geometry.time(), 1e-7,
                           context.reuse);
  Way way = moving.way(from, 0.0, receiver.track, receiver.offset);
  way.leg.kind = Leg::Kind::source_to_array;
  way.leg.array = context.array;
  way.leg.channel = channel;
  found.end = way.end.position;
  if (geometry.is_own(context.array))
    std::erase_if(way.leg.arrivals, [](const Arrival& path) {
      return path.surface_bounces + path.bottom_bounces == 0;
    });
  for (const Arrival& path : way.leg.arrivals)
    found.met.push_back(moving.meet(from, 0.0, receiver.track, receiver.offset, way, path));
  found.leg = std::move(way.leg);
  return found;
}

DirectBlast direct_blast(const EchoContext& context) {
  DirectBlast blast;
  const Scenario& scenario = context.scenario();
  const auto phones = context.geometry.array(context.array).phones.size();
  const auto receive_at_phones = [&](DirectBlast& into) {
    for (std::size_t n = 0; n < phones; ++n) receive(context, static_cast<int>(n), into);
  };
  if (scenario.propagation.exact_per_phone) {
    receive_at_phones(blast);
    return blast;
  }
  const Vec3 place = receive(context, -1, blast);
  if (context.listens && !plane_waves(context, blast, place)) {
    DirectBlast at_phones;
    receive_at_phones(at_phones);
    blast.received = std::move(at_phones.received);
  }
  return blast;
}

}  // namespace asdic::detail
