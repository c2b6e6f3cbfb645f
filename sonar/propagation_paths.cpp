#include "sonar/propagation_paths.h"

#include <algorithm>
#include <cmath>

#include "raytrace/ocean/slice.h"
#include "sonar/followed_path.h"
#include "sonar/geometry.h"

namespace asdic {
namespace {

constexpr std::size_t most_slices = 64;

/// No wider than paths that were known a moment before ask for: their bounces, and launch angles up
/// to a degree beyond (as same_path in moving_paths.h).
PathLimits limits_around(std::span<const Arrival> known, PathLimits limits) {
  PathLimits needed{.max_surface_bounces = 0, .max_bottom_bounces = 0, .max_launch_angle = 0.0};
  for (const Arrival& path : known) {
    needed.max_surface_bounces = std::max(needed.max_surface_bounces, path.surface_bounces);
    needed.max_bottom_bounces = std::max(needed.max_bottom_bounces, path.bottom_bounces);
    needed.max_launch_angle =
        std::max(needed.max_launch_angle, std::abs(path.launch_elevation) + radians(1.0));
  }
  limits.max_surface_bounces = std::min(limits.max_surface_bounces, needed.max_surface_bounces);
  limits.max_bottom_bounces = std::min(limits.max_bottom_bounces, needed.max_bottom_bounces);
  limits.max_launch_angle = std::min(limits.max_launch_angle, needed.max_launch_angle);
  return limits;
}

}  // namespace

PathLimits limits_of(const PropagationSettings& settings) noexcept {
  return {.max_surface_bounces = settings.max_surface_bounces,
          .max_bottom_bounces = settings.max_bottom_bounces,
          .max_launch_angle = settings.max_launch_angle};
}

PropagationPaths::PropagationPaths(const Environment& ocean, const Transect& transect)
    : along_(ocean), transect_(transect), layered_(is_layered(ocean)) {}

Plane PropagationPaths::plane(const Vec3& from, double bearing) const noexcept {
  return {.origin = along(from), .cos_beta = std::cos(bearing - transect_.bearing)};
}

Plane PropagationPaths::plane(const Vec3& from, const Vec3& to) const noexcept {
  return plane(from, separation(from, to).bearing);
}

double PropagationPaths::surface_depth(const Vec3& place) const noexcept {
  return along_.environment().surface.depth_at(along(place));
}

double PropagationPaths::bottom_depth(const Vec3& place) const noexcept {
  return along_.environment().bottom.depth_at(along(place));
}

double PropagationPaths::speed_at(const Vec3& place) const noexcept {
  const Environment& ocean = along_.environment();
  if (layered_) return ocean.water.at(place.z()).c;
  return sound_speed(ocean, along(place), place.z()).c;
}

std::shared_ptr<const EigenraySolver> PropagationPaths::solver(const Plane& plane) const {
  if (layered_) return {std::shared_ptr<void>(), &along_};  // not owned
  const std::pair key(plane.origin, plane.cos_beta);
  {
    const std::scoped_lock lock(lock_);
    if (const auto kept = slices_.find(key); kept != slices_.end()) return kept->second;
  }
  auto made = std::make_shared<const EigenraySolver>(
      slice(along_.environment(), plane.origin, plane.cos_beta));
  const std::scoped_lock lock(lock_);
  if (slices_.size() >= most_slices) slices_.clear();
  return slices_.emplace(key, std::move(made)).first->second;
}

Arrivals PropagationPaths::find(const Vec3& from, const Vec3& to, double frequency,
                                const PathLimits& limits) const {
  const double range = separation(from, to).range;
  if (layered_) return along_.find(from.z(), to.z(), range, frequency, limits);
  return solver(plane(from, to))->find(from.z(), to.z(), range, frequency, limits);
}

Arrivals PropagationPaths::follow(std::span<const Arrival> known, const Vec3& from, const Vec3& to,
                                  double frequency, const PathLimits& limits) const {
  if (layered_) return find(from, to, frequency, limits_around(known, limits));
  const Plane line = plane(from, to);
  const RayTracer tracer(slice(along_.environment(), line.origin, line.cos_beta), frequency);
  Arrivals followed;
  for (const Arrival& path : known) {
    auto same = followed_path(tracer, path, from.z(), to.z(), separation(from, to).range);
    if (!same) return find(from, to, frequency, limits);
    followed.push_back(std::move(*same));
  }
  return followed;
}

}  // namespace asdic
