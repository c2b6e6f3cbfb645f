#include "raytrace/paths/drawn_path.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

/// The greater of the curvatures at the ends of a segment, |∂c/∂n|/c [1/m].
double curvature(const RaySegment& s) noexcept {
  const double begin = std::abs(-s.c_r_begin * s.begin.zeta + s.c_z_begin * s.begin.xi);
  const double end = std::abs(-s.c_r_end * s.end.zeta + s.c_z_end * s.end.xi);
  return std::max(begin, end);
}

}  // namespace

RayPath drawn_path(const RayTrajectory& ray, double length, double sagitta, double depth_step) {
  RayPath path;
  path.launch_elevation = path.final_elevation = ray.launch_elevation;
  const auto add = [&](const RayState& y) { path.points.push_back({y.range, y.depth, y.time}); };
  for (const RaySegment& s : ray.segments) {
    if (path.points.empty()) add(s.begin);
    if (s.begin.length >= length) break;
    const double arc = std::min(s.end.length, length) - s.begin.length;
    // a chord of length L on a curve of curvature κ is L²κ/8 off
    const double parts = std::ceil(std::max(arc * std::sqrt(curvature(s) / (8.0 * sagitta)),
                                            std::abs(s.end.depth - s.begin.depth) / depth_step));
    const int n = static_cast<int>(std::clamp(parts, 1.0, 1e4));
    for (int i = 1; i < n; ++i) add(state_at(s, arc * i / n));
    const RayState last = s.end.length <= length ? s.end : state_at(s, arc);
    if (arc > 0.0 || path.points.size() == 1) add(last);
    path.path_length = last.length;
    path.final_elevation = std::atan2(-last.zeta, last.xi);
    path.surface_bounces = s.history.surface_bounces;
    path.bottom_bounces = s.history.bottom_bounces;
    path.turns = s.history.upper_turns + s.history.lower_turns;
  }
  const bool whole = ray.segments.empty() || ray.segments.back().end.length <= length;
  if (whole && static_cast<std::size_t>(path.surface_bounces + path.bottom_bounces) <
                   ray.bounces.size()) {  // it ended at a boundary: that bounce counts
    path.surface_bounces = path.bottom_bounces = 0;
    for (const Bounce& bounce : ray.bounces)
      ++(bounce.boundary == BoundaryKind::surface ? path.surface_bounces : path.bottom_bounces);
  }
  const auto bounces = std::min(
      ray.bounces.size(), static_cast<std::size_t>(path.surface_bounces + path.bottom_bounces));
  for (std::size_t i = 0; i < bounces; ++i)
    if (ray.bounces[i].boundary == BoundaryKind::surface)
      path.surface_hits.push_back(ray.bounces[i].range);
  return path;
}

}  // namespace asdic::detail
