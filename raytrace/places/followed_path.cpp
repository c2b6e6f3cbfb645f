#include "raytrace/places/followed_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "raytrace/ocean/tube_amplitude.h"

namespace asdic::detail {
namespace {

constexpr double near_enough = 1e-4;  // miss at the receiver [m]: τ is right to second order
constexpr double least_reach = 0.02;  // of the launch angle, that is searched at least [rad]
constexpr int most_steps = 12;

/// The path that a ray is which ends at the receiver. Equations as in docs/theory/layered-rays.md.
/// \param miss  depth of the receiver below the ray's end [m]
Arrival described(const RayTrajectory& ray, Spreading spreading, const Arrival& before,
                  double miss) {
  const RaySegment& last = ray.segments.back();
  const RayState& end = last.end;
  Arrival path = before;  // counts are the same
  path.launch_elevation = ray.launch_elevation;
  path.arrival_elevation = std::atan2(-end.zeta, end.xi);
  path.delay = end.time + end.zeta * miss;  // ∂τ/∂z = ζ
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

/// Rays of a history to the receiver's range, by launch angle.
class RaysOfHistory {
 public:
  RaysOfHistory(const RayTracer& tracer, const Arrival& path, double source_depth,
                double receiver_depth, double range)
      : tracer_(tracer),
        path_(path),
        source_depth_(source_depth),
        receiver_depth_(receiver_depth),
        limits_{.min_range = -range,
                .max_range = range,
                .max_surface_bounces = path.surface_bounces + 1,
                .max_bottom_bounces = path.bottom_bounces + 1} {}

  /// How far below the ray the receiver is [m]; nothing if the ray is of another history.
  std::optional<double> miss(double angle) {
    tracer_.trace(0.0, source_depth_, angle, limits_, ray_);
    if (ray_.ended != RayEnd::box || ray_.segments.empty() || !same_history(ray_, path_)) return {};
    const RaySegment& last = ray_.segments.back();
    if (!(std::abs(last.end.range - limits_.max_range) < 1e-6)) return {};
    return receiver_depth_ - last.end.depth;
  }
  /// Newton's step from the last ray [rad]: ∂z/∂α at fixed range = ∓q/cos θ, the normal changes
  /// sides at every bounce.
  [[nodiscard]] double step(double miss) const {
    const double side = (path_.surface_bounces + path_.bottom_bounces) % 2 == 0 ? -1.0 : 1.0;
    return miss * cosine() / (side * ray_.segments.back().end.q);
  }
  [[nodiscard]] bool meets(double miss) const { return std::abs(miss) * cosine() < near_enough; }
  /// Angle under which the source sees that miss of the last ray, along a straight line of its
  /// length [rad].
  [[nodiscard]] double angle_of(double miss) const {
    return std::abs(miss) * cosine() / std::max(path_.path_length, 1e-3);
  }
  [[nodiscard]] Arrival arrival() const {
    return described(ray_, spreading_across(tracer_.environment()), path_,
                     receiver_depth_ - ray_.segments.back().end.depth);
  }

 private:
  [[nodiscard]] double cosine() const {
    const RaySegment& last = ray_.segments.back();
    return last.c_end * last.end.xi;
  }

  const RayTracer& tracer_;
  const Arrival& path_;
  double source_depth_, receiver_depth_;
  TraceLimits limits_;
  RayTrajectory ray_;
};

/// A ray of an angle, and how far it misses.
struct Miss {
  double angle, miss;
};

/// The ray between two that miss on either side, by regula falsi (Illinois).
std::optional<Arrival> between(RaysOfHistory& rays, Miss low, Miss high) {
  int kept = 0;  // the end that stayed: −1 the low one, +1 the high one
  for (int i = 0; i < 50; ++i) {
    const double angle = low.angle + (high.angle - low.angle) * low.miss / (low.miss - high.miss);
    const auto miss = rays.miss(angle);
    if (!miss) return {};
    if (rays.meets(*miss)) return rays.arrival();
    if ((*miss > 0.0) == (low.miss > 0.0)) {
      low = {angle, *miss};
      if (std::exchange(kept, 1) == 1) high.miss *= 0.5;
    } else {
      high = {angle, *miss};
      if (std::exchange(kept, -1) == -1) low.miss *= 0.5;
    }
  }
  return {};
}

}  // namespace

std::optional<Arrival> followed_path(const RayTracer& tracer, const Arrival& path,
                                     double source_depth, double receiver_depth, double range) {
  RaysOfHistory rays(tracer, path, source_depth, receiver_depth, range);
  double angle = path.launch_elevation, reach = least_reach;
  Miss before{angle, 1e300};
  for (int step = 0; step < most_steps; ++step) {
    const auto miss = rays.miss(angle);
    if (!miss) return {};
    if (rays.meets(*miss)) return rays.arrival();
    if (step == 0) reach = std::max(reach, 4.0 * rays.angle_of(*miss));
    // A step that did not bring it near was not the curve's: over curvilinear facets q is that of
    // the turning tangent.
    double turn = rays.step(*miss);
    if (std::abs(*miss) > 0.1 * std::abs(before.miss) && *miss != before.miss)
      turn = -*miss * (angle - before.angle) / (*miss - before.miss);
    before = {angle, *miss};
    angle += turn;
    if (!(std::abs(angle - path.launch_elevation) < reach)) return {};
  }
  return {};
}

std::optional<Arrival> path_beside(const RayTracer& tracer, const Arrival& path,
                                   double source_depth, double receiver_depth, double range) {
  constexpr double nearest = 1e-7, furthest = 2.6e-3;  // from the known angle [rad]
  RaysOfHistory rays(tracer, path, source_depth, receiver_depth, range);
  const double angle = path.launch_elevation;
  const auto middle = rays.miss(angle);
  std::array<std::optional<Miss>, 2> ends;  // so far, below and above
  if (middle) ends.fill(Miss{angle, *middle});
  for (double aside = nearest; aside < furthest; aside *= 2.0)
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const double there = angle + (side == 0 ? -aside : aside);
      const auto miss = rays.miss(there);
      if (miss && ends[side] && (*miss > 0.0) != (ends[side]->miss > 0.0))
        if (auto found = between(rays, *ends[side], {there, *miss})) return found;
      ends[side] = miss ? std::optional(Miss{there, *miss}) : std::nullopt;
    }
  return {};
}

}  // namespace asdic::detail
