#include "sonar/echoes/one_leg.h"

#include <algorithm>
#include <cmath>

#include "core/doppler.h"
#include "core/mixed_bits.h"
#include "reverb/scattering/forward_scatter.h"

namespace asdic::detail {

EchoPath received_along(const EchoContext& context, const Kinematics& sender, const MetPath& met) {
  const double c_sender = context.paths.speed_at(sender.position);
  const double c_array = context.paths.speed_at(met.way.end.position);
  const double line = met.way.leg.bearing, bearing = launch_bearing(met.path, line);
  const Vec3 leaving = leaving_slowness(line, met.path, c_sender);
  const Vec3 at_array = arriving_slowness(line, met.path, c_array);
  EchoPath path;
  path.target = -1;
  path.array = context.array;
  path.received = {
      .delay = met.time,
      .amplitude = met.path.amplitude * context.pattern.towards(bearing, met.path.launch_elevation),
      .doppler = leg_doppler({sender.velocity, leaving}, {met.way.end.velocity, at_array}),
      .slowness = met_by(met.way.end.velocity, at_array)};
  path.response = {.path_length = met.path.path_length,
                   .bearing = bearing,
                   .elevation = met.path.launch_elevation,
                   .without_pattern = met.path.amplitude};
  return path;
}

void scatter_along(const EchoContext& context, const Kinematics& sender, double sent,
                   const MetPath& met, std::uint64_t ends, const EchoPath& received,
                   SeaDraws& draws, std::vector<EchoPath>& found) {
  constexpr int parts = 16;
  const Arrival& path = met.path;
  if (!(path.scattered > 1e-9 * std::norm(path.amplitude))) return;
  const double c = context.paths.speed_at(met.way.end.position);
  const Scenario& scenario = context.scenario();
  const std::uint64_t entity = mixed(ends, scatter_history(path));
  const RoughPath rough =
      rough_path(scenario.environment, path, context.frequency, parts, draws, entity);
  const ScatteredLeg leg{&rough, sender.position.head<2>(), met.way.leg.bearing,
                         context.geometry.time() + sent};
  for (const ScatteredPart& part :
       forward_scatter(scenario.environment, std::span(&leg, 1), context.frequency, parts,
                       scenario.seed, entity)) {
    EchoPath one = received;
    one.curve.reset();
    one.received.delay += part.delay;
    one.received.doppler *= 1.0 + part.shift / context.frequency;
    one.received.slowness =
        met_by(met.way.end.velocity,
               slowness_vector(arrival_bearing(path, met.way.leg.bearing) + part.bearing,
                               path.arrival_elevation + part.elevation, c));
    one.response.without_pattern = std::sqrt(path.scattered) * part.amplitude;
    one.received.amplitude = one.response.without_pattern *
                             context.pattern.towards(one.response.bearing, one.response.elevation);
    found.push_back(std::move(one));
  }
}

void shorten_bounces(Arrivals& paths, std::size_t receivers) {
  constexpr std::size_t many_paths = 256, most = 256, least = 8;
  if (paths.size() <= many_paths) return;
  const std::size_t kept = std::max(least, most / std::max<std::size_t>(1, receivers));
  for (Arrival& path : paths)
    if (path.bounces.size() > kept)
      path.bounces = {path.bounces.begin(),
                      path.bounces.begin() + static_cast<std::ptrdiff_t>(kept)};
}

}  // namespace asdic::detail
