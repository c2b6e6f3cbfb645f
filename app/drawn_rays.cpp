#include "app/drawn_rays.h"

#include <algorithm>
#include <cmath>

#include "raytrace/ray_path.h"
#include "sonar/geometry.h"

namespace asdic::app {
namespace {

constexpr int fan_rays = 41;
constexpr std::size_t most_eigenrays = 100;  // a target
constexpr double margin = 1.03;              // past the furthest thing of interest

std::vector<double> fan(const Transmitter& transmitter) {
  const bool all_round = transmitter.taper == Taper::omnidirectional;
  const double half = all_round ? radians(20.0) : 1.5 * transmitter.beamwidth;
  const double axis = all_round ? 0.0 : transmitter.elevation;
  std::vector<double> elevations;
  for (int i = 0; i < fan_rays; ++i)
    elevations.push_back(
        std::clamp(axis + half * (2.0 * i / (fan_rays - 1) - 1.0), radians(-89.0), radians(89.0)));
  return elevations;
}

double time_at(const RayPath& ray, double range) {
  const auto point = std::find_if(ray.points.begin(), ray.points.end(),
                                  [&](const RayPoint& p) { return p.range >= range; });
  return point == ray.points.end() ? infinity : point->time;
}

RayPaths::Path drawn(const RayPath& ray, RayPaths::Kind kind) {
  RayPaths::Path path{.kind = kind, .launch_elevation = ray.launch_elevation};
  for (const RayPoint& point : ray.points) {
    path.range.push_back(point.range);
    path.depth.push_back(point.depth);
  }
  return path;
}

}  // namespace

RayPaths drawn_rays(const PingSimulator& simulator) {
  const Scenario& scenario = simulator.scenario();
  const Environment& ocean = scenario.environment;
  const Vec3 source = scenario.platform.at(0.0).position;
  const PropagationSettings& limits = scenario.propagation;
  const int bounces = limits.max_surface_bounces + limits.max_bottom_bounces;
  const double one_way = 0.5 * (scenario.pings.recording_start + scenario.pings.recording_duration);
  const double c = ocean.water.at(source.z()).c;
  const std::vector<double> elevations = fan(simulator.transmitter(1));

  double extent = 0.0;
  for (const double elevation : elevations) {
    const RayPath ray = trace_ray(ocean, source.z(), elevation, c * one_way, 50.0, bounces);
    for (const double hit : ray.surface_hits)
      if (time_at(ray, hit) <= one_way) extent = std::max(extent, hit);
  }
  for (const Target& target : scenario.targets)
    extent = std::max(extent, separation(source, target.track.at(0.0).position).range);
  extent = extent > 0.0 ? margin * extent : 0.5 * c * one_way;

  RayPaths result;
  for (const double elevation : elevations) {
    const RayPath ray = trace_ray(ocean, source.z(), elevation, extent, 50.0, bounces);
    result.paths.push_back(drawn(ray, RayPaths::Kind::fan));
    result.hit_range.insert(result.hit_range.end(), ray.surface_hits.begin(),
                            ray.surface_hits.end());
  }
  for (const Target& target : scenario.targets) {
    if (target.first_ping > 1 || target.last_ping < 1) continue;
    const Vec3 position = target.track.at(0.0).position;
    const double range = separation(source, position).range;
    const Arrivals arrivals = simulator.ocean().find(
        source.z(), position.z(), range, simulator.pulse().centre_frequency(),
        {.max_surface_bounces = limits.max_surface_bounces,
         .max_bottom_bounces = limits.max_bottom_bounces,
         .max_launch_angle = limits.max_launch_angle});
    for (std::size_t i = 0; i < std::min(arrivals.size(), most_eigenrays); ++i)
      result.paths.push_back(
          drawn(trace_ray(ocean, source.z(), arrivals[i].launch_elevation, range),
                RayPaths::Kind::eigenray));
  }
  std::sort(result.hit_range.begin(), result.hit_range.end());
  return result;
}

}  // namespace asdic::app
