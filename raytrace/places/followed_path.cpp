#include "raytrace/places/followed_path.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/tube_amplitude.h"

namespace asdic::detail {
namespace {

constexpr double near_enough = 1e-4;    // miss at the receiver [m]: τ is stationary, so 1e-12 s
constexpr double furthest_turn = 0.02;  // of the launch angle [rad]
constexpr int most_steps = 8;

/// The path that a ray is which ends at the receiver. Equations as in docs/theory/layered-rays.md.
Arrival described(const RayTrajectory& ray, Spreading spreading, const Arrival& before) {
  const RaySegment& last = ray.segments.back();
  const RayState& end = last.end;
  Arrival path = before;  // counts are the same
  path.launch_elevation = ray.launch_elevation;
  path.arrival_elevation = std::atan2(-end.zeta, end.xi);
  path.delay = end.time;
  path.q = end.q;
  path.path_length = end.length;
  path.horizontal_slowness = end.xi;
  path.absorption_db = db_from_amplitude(std::exp(end.nepers));
  path.reflection = last.history.reflection;
  path.spreading = tube_amplitude(
      spreading, {.speed = last.c_end,
                  .q = end.q,
                  .range = end.range,
                  .launch_slowness = launch_slowness(ray.launch_elevation, ray.source_speed),
                  .speed_integral = end.speed_integral});
  const double absorbed = std::exp(-end.nepers);
  path.amplitude = path_amplitude(path.spreading, absorbed, path.reflection, path.caustics);
  path.scattered = scattered_power(path.spreading, absorbed, last.history.scattered);
  path.bounces = ray.bounces;
  return path;
}

bool same_history(const RayTrajectory& ray, const Arrival& path) {
  const RayHistory& h = ray.segments.back().history;
  return h.surface_bounces == path.surface_bounces && h.bottom_bounces == path.bottom_bounces &&
         h.upper_turns == path.upper_turns && h.lower_turns == path.lower_turns;
}

}  // namespace

std::optional<Arrival> followed_path(const RayTracer& tracer, const Arrival& path,
                                     double source_depth, double receiver_depth, double range) {
  const TraceLimits limits{.min_range = -range,
                           .max_range = range,
                           .max_surface_bounces = path.surface_bounces + 1,
                           .max_bottom_bounces = path.bottom_bounces + 1};
  const double side = (path.surface_bounces + path.bottom_bounces) % 2 == 0 ? -1.0 : 1.0;
  RayTrajectory ray;
  double angle = path.launch_elevation;
  for (int step = 0; step < most_steps; ++step) {
    tracer.trace(0.0, source_depth, angle, limits, ray);
    if (ray.ended != RayEnd::box || ray.segments.empty() || !same_history(ray, path)) return {};
    const RaySegment& last = ray.segments.back();
    if (!(std::abs(last.end.range - range) < 1e-6)) return {};
    const double cosine = last.c_end * last.end.xi;
    const double miss = receiver_depth - last.end.depth;
    if (std::abs(miss) * cosine < near_enough)
      return described(ray, spreading_across(tracer.environment()), path);
    // ∂z/∂α at fixed range = ∓q/cos θ: the normal changes sides at every bounce.
    angle += miss * cosine / (side * last.end.q);
    if (!(std::abs(angle - path.launch_elevation) < furthest_turn)) return {};
  }
  return {};
}

}  // namespace asdic::detail
