#include "sonar/ping_bounds.h"

#include <algorithm>
#include <cmath>

#include "reverb/patches.h"

namespace asdic {
namespace {

constexpr double finest_ground = 1.0;  // [m]

double fastest_water(const Environment& ocean) {
  double fastest = 0.0;
  if (ocean.section) {
    for (const double c : ocean.section->speeds()) fastest = std::max(fastest, c);
    return fastest;
  }
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  for (double z = 0.0; z <= bottom; z += 50.0) fastest = std::max(fastest, ocean.water.at(z).c);
  return fastest;
}

/// By default from the pulse's bandwidth; a surface with a shape is sampled facet by facet.
double ground_grid(const Scenario& scenario, const Pulse& pulse, const PropagationPaths& paths) {
  if (scenario.reverberation.ground_spacing) return *scenario.reverberation.ground_spacing;
  const double by_pulse =
      asdic::ground_spacing(pulse.bandwidth_40db(), speed_at_surface(scenario, paths));
  const auto& shape = scenario.environment.surface.shape;
  if (!shape || shape->ranges().size() < 2) return by_pulse;
  const double facet = (shape->ranges().back() - shape->ranges().front()) /
                       static_cast<double>(shape->ranges().size() - 1);
  return std::min(by_pulse, std::max(facet, finest_ground));
}

}  // namespace

double fastest(const Track& track) {
  double speed = track.waypoints.empty() ? track.start.velocity.norm() : 0.0;
  for (std::size_t i = 0; i + 1 < track.waypoints.size(); ++i) {
    const Waypoint &a = track.waypoints[i], &b = track.waypoints[i + 1];
    speed = std::max(speed, (b.position - a.position).norm() / (b.time - a.time));
  }
  return speed;
}

double doppler_bound(const Scenario& scenario) {
  double target = 0.0;
  for (const Target& t : scenario.targets) target = std::max(target, fastest(t.track));
  double platform = 0.0;
  for (const Platform& p : scenario.platforms) platform = std::max(platform, fastest(p.track));
  constexpr double slowest_sea = 1300.0;
  return 2.2 * (platform + target) / slowest_sea;
}

double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths) {
  Vec3 place = scenario.platforms[0].track.at(0.0).position;
  place.z() = paths.surface_depth(place);
  return paths.speed_at(place);
}

SurfaceGround::Settings ground_settings(const Scenario& scenario, const Pulse& pulse,
                                        const PropagationPaths& paths) {
  const PingSchedule& pings = scenario.pings;
  return {.azimuths = scenario.reverberation.azimuths,
          .spacing = ground_grid(scenario, pulse, paths),
          .max_range = 0.5 * fastest_water(scenario.environment) *
                       (pings.recording_start + pings.recording_duration),
          .frequency = pulse.centre_frequency(),
          .limits = limits_of(scenario.propagation)};
}

}  // namespace asdic
