#include "sonar/scenario/ping_bounds.h"

#include <algorithm>
#include <cmath>

#include "reverb/scattering/forward_scatter.h"
#include "reverb/scattering/motion.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {

double fastest_water(const Environment& ocean) {
  double fastest = 0.0;
  if (ocean.section) {
    for (const double c : ocean.section->speeds()) fastest = std::max(fastest, c);
    return fastest;
  }
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  constexpr double step = 50.0;
  for (int i = 0; i * step <= bottom; ++i) fastest = std::max(fastest, ocean.water.at(i * step).c);
  return fastest;
}

double fastest_water(const Scenario& scenario) {
  const double along = fastest_water(scenario.environment);
  if (!scenario.area || !scenario.area->water()) return along;
  constexpr double no_slower = 1600.0;
  const double heard = 0.5 * no_slower * end_of_record(scenario);
  const Vec3 place = scenario.platforms[0].track.at(0.0).position;
  return std::max(along, scenario.area->bounds(place.head<2>(), heard).fastest);
}

double fastest(const Track& track) {
  double speed = track.waypoints.empty() ? track.start.velocity.norm() : 0.0;
  for (std::size_t i = 0; i + 1 < track.waypoints.size(); ++i) {
    const Waypoint &a = track.waypoints[i], &b = track.waypoints[i + 1];
    speed = std::max(speed, (b.position - a.position).norm() / (b.time - a.time));
  }
  return speed;
}

namespace {

/// Of scatterers alone: drift, own velocities held at four standard deviations, Bragg lines.
double sea_doppler(const Scenario& scenario) {
  const ReverberationSettings& r = scenario.reverberation;
  if (!r.enabled) return 0.0;
  constexpr double slowest_sea = 1300.0;
  double largest = 0.0;
  const auto add = [&](const ScattererField& field) {
    const ScattererMotion& motion = field.motion;
    double bound = 2.2 * motion.current.norm() / slowest_sea;
    if (motion.kind == ScattererMotion::Kind::spread)
      bound += 2.2 * 4.0 * std::sqrt(3.0) * motion.speed_rms / slowest_sea;
    if (motion.kind == ScattererMotion::Kind::bragg)
      for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
        const double f = Pulse(pulse_of(scenario, static_cast<int>(t))).centre_frequency();
        bound = std::max(bound, 1.1 * bragg_shift(4.0 * pi * f / slowest_sea) / f);
      }
    largest = std::max(largest, bound);
  };
  if (r.surface_scatters) add(r.surface_field);
  if (r.bottom) add(r.bottom_field);
  for (const VolumeLayer& layer : r.volume) add(layer.field);
  return largest;
}

/// Of what a rough sea scatters about the paths of echoes.
double rough_sea_doppler(const Scenario& scenario) {
  double largest = 0.0;
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t)
    largest = std::max(
        largest,
        scatter_doppler(scenario.environment,
                        Pulse(pulse_of(scenario, static_cast<int>(t))).centre_frequency()));
  return largest;
}

}  // namespace

double doppler_bound(const Scenario& scenario) {
  double target = 0.0;
  for (const Target& t : scenario.targets) target = std::max(target, fastest(t.track));
  double platform = 0.0;
  for (const Platform& p : scenario.platforms) platform = std::max(platform, fastest(p.track));
  constexpr double slowest_sea = 1300.0;
  return 2.2 * (platform + target) / slowest_sea + sea_doppler(scenario) +
         rough_sea_doppler(scenario);
}

}  // namespace asdic::detail
