#include "io/ping/drawn_rays.h"

#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "raytrace/paths/trace_ray.h"
#include "raytrace/volume/volume_eigenrays.h"

namespace asdic::detail {
namespace {

constexpr int fan_rays = 41;
constexpr std::size_t most_eigenrays = 100;  // a target
constexpr double margin = 1.03;              // past the furthest thing of interest

std::vector<double> fan(const Transmitter& transmitter) {
  const auto* const line = std::get_if<LineBeam>(&transmitter.beam);
  const bool narrow = line != nullptr && line->taper != Taper::omnidirectional;
  const double half = narrow ? 1.5 * line->steered_width(transmitter.elevation) : radians(20.0);
  const double axis = narrow ? transmitter.elevation : 0.0;
  std::vector<double> elevations;
  elevations.reserve(fan_rays);
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

/// An eigenray of a volume, unrolled: horizontal distances from the source.
RayPaths::Path unrolled(std::span<const Vec3> track, double launch_elevation) {
  RayPaths::Path path{.kind = RayPaths::Kind::eigenray, .launch_elevation = launch_elevation};
  for (const Vec3& place : track) {
    path.range.push_back(separation(track.front(), place).range);
    path.depth.push_back(place.z());
  }
  return path;
}

/// A boundary of a plane out to a range, where it is not flat.
RayPaths::Line line(const Boundary& boundary, double extent) {
  constexpr int points = 500;
  RayPaths::Line line;
  if (!boundary.shape) return line;
  for (int i = 0; i <= points; ++i) line.range.push_back(extent * i / points);
  for (const double node : boundary.shape->ranges())
    if (node > 0.0 && node < extent) line.range.push_back(node);
  std::sort(line.range.begin(), line.range.end());
  for (const double range : line.range) line.depth.push_back(boundary.depth_at(range));
  return line;
}

/// Towards the first target that is there; else along the transect.
double bearing_of_fan(const Scenario& scenario, const Vec3& source) {
  for (const Target& target : scenario.targets)
    if (target.first_ping <= 1 && target.last_ping >= 1)
      return separation(source, target.track.at(0.0).position).bearing;
  return scenario.transect.bearing;
}

}  // namespace

RayPaths drawn_rays(const PingSimulator& simulator) {
  const Scenario& scenario = simulator.scenario();
  const PropagationPaths& paths = simulator.paths();
  const Vec3 source = simulator.geometry(1).source().position;  // whose fan is drawn
  const PropagationSettings& limits = scenario.propagation;
  const int bounces = limits.max_surface_bounces.value_or(fewest_bounces) +
                      limits.max_bottom_bounces.value_or(fewest_bounces);
  const double one_way = 0.5 * (scenario.pings.recording_start + scenario.pings.recording_duration);
  const double c = paths.speed_at(source);
  const std::vector<double> elevations = fan(simulator.transmitter(1));
  const double bearing = bearing_of_fan(scenario, source);
  const auto along_fan = paths.solver(paths.plane(source, bearing, c * one_way));
  const Environment& ocean = along_fan->environment();

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
  if (!paths.layered()) {
    result.bearing = bearing;
    result.bottom = line(ocean.bottom, extent);
    result.surface = line(ocean.surface, extent);
  }
  for (const double elevation : elevations) {
    const RayPath ray = trace_ray(ocean, source.z(), elevation, extent, 50.0, bounces);
    result.paths.push_back(drawn(ray, RayPaths::Kind::fan));
    result.hit_range.insert(result.hit_range.end(), ray.surface_hits.begin(),
                            ray.surface_hits.end());
  }
  for (const Target& target : scenario.targets) {
    if (target.first_ping > 1 || target.last_ping < 1) continue;
    const Vec3 position = target.track.at(0.0).position;
    const Separation way = separation(source, position);
    if (const VolumeOcean* volume = paths.volume()) {
      const double frequency = simulator.pulse().centre_frequency();
      const Arrivals arrivals = paths.find(source, position, frequency, limits_of(limits));
      const VolumeTracer tracer(*volume, frequency);
      for (std::size_t i = 0; i < std::min(arrivals.size(), most_eigenrays); ++i)
        result.paths.push_back(unrolled(volume_track(tracer, arrivals[i], source, position),
                                        arrivals[i].launch_elevation));
      continue;
    }
    const auto plane = paths.solver(paths.plane(source, way.bearing, way.range));
    const Arrivals arrivals = plane->find(source.z(), position.z(), way.range,
                                          simulator.pulse().centre_frequency(), limits_of(limits));
    for (std::size_t i = 0; i < std::min(arrivals.size(), most_eigenrays); ++i)
      result.paths.push_back(drawn(
          trace_ray(plane->environment(), source.z(), arrivals[i].launch_elevation, way.range),
          RayPaths::Kind::eigenray));
  }
  std::sort(result.hit_range.begin(), result.hit_range.end());
  return result;
}

}  // namespace asdic::detail
