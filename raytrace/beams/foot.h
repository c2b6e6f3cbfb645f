#pragma once
#include <algorithm>
#include <cmath>

#include "raytrace/beams/beam.h"

namespace asdic {

/// Where the normal of a ray meets a receiver.
struct Foot {
  const RaySegment* segment = nullptr;
  RayState state;                       ///< of the ray, at the foot
  double n = 0.0;                       ///< distance of the receiver along the normal [m], positive
                                        ///< to the right of the ray's travel (down, if it goes out)
  std::complex<double>* sum = nullptr;  ///< the receiver's
};

namespace beams {

/// Along-track and cross-track distance from a state of a ray to a receiver.
struct RayCoordinates {
  double along = 0.0, across = 0.0;
};

inline RayCoordinates ray_coordinates(const RayState& state, double range, double depth) noexcept {
  const double c = 1.0 / std::hypot(state.xi, state.zeta);
  const double dr = range - state.range, dz = depth - state.depth;
  return {c * (dr * state.xi + dz * state.zeta), c * (dz * state.xi - dr * state.zeta)};
}

/// The state of the segment whose normal passes through the receiver, which lies ahead of the
/// segment's begin and behind its end. Regula falsi kept in its bracket (Illinois); the function is
/// a straight line but for the ray's curvature, so two or three steps reach a micrometre.
inline RayState foot_state(const RaySegment& segment, double range, double depth, double ahead,
                           double behind) noexcept {
  double a = 0.0, b = segment.end.length - segment.begin.length;
  double fa = ahead, fb = behind;
  RayState state = segment.begin;
  for (int i = 0; i < 60; ++i) {
    const double s = a + (b - a) * fa / (fa - fb);
    state = state_at(segment, s);
    const double f = ray_coordinates(state, range, depth).along;
    if (std::abs(f) < 1e-6 || b - a < 1e-7) break;
    if (f >= 0.0) {
      a = s, fa = f;
      fb *= 0.5;
    } else {
      b = s, fb = f;
      fa *= 0.5;
    }
  }
  return state;
}

}  // namespace beams

/// Calls visit(foot) for every receiver within `reach(segment)` [m] of the ray that a normal of a
/// segment meets, segment by segment. A segment owns the normal of its begin, not that of its end;
/// where the ray is reflected the normals swing without meeting anybody. \param image  the depth at
/// which the ray takes a receiver for: its own, or that of its mirror image
///               (`image(image(z)) = z`)
template <class Reach, class Image, class Visit>
void for_each_foot(const RayTrajectory& ray, FieldSum& field, Reach&& reach, Image&& image,
                   Visit&& visit) {
  const auto ranges = field.ranges, depths = field.depths;
  for (const RaySegment& segment : ray.segments) {
    const RayState &from = segment.begin, &to = segment.end;
    const double width = reach(segment);
    const auto serve = [&](std::size_t column, double depth, std::complex<double>* sum) {
      const double range = ranges[column];
      depth = image(depth);
      const double ahead = beams::ray_coordinates(from, range, depth).along;
      const double behind = beams::ray_coordinates(to, range, depth).along;
      if (!(ahead >= 0.0 && behind < 0.0)) return;
      Foot foot{.segment = &segment,
                .state = beams::foot_state(segment, range, depth, ahead, behind),
                .sum = sum};
      foot.n = beams::ray_coordinates(foot.state, range, depth).across;
      if (std::abs(foot.n) <= width) visit(foot);
    };
    const double cosine = std::max(std::abs(from.xi) / std::hypot(from.xi, from.zeta),
                                   std::abs(to.xi) / std::hypot(to.xi, to.zeta));
    const double sine = std::max(std::abs(from.zeta) / std::hypot(from.xi, from.zeta),
                                 std::abs(to.zeta) / std::hypot(to.xi, to.zeta));
    const double edges[2] = {image(std::min(from.depth, to.depth) - width * cosine),
                             image(std::max(from.depth, to.depth) + width * cosine)};
    const double top = std::min(edges[0], edges[1]), bottom = std::max(edges[0], edges[1]);
    // The ray may bulge a little beyond its end points in range; nothing is lost, the feet decide.
    const double left = std::min(from.range, to.range) - width * sine;
    const double right = std::max(from.range, to.range) + width * sine;
    const auto first = static_cast<std::size_t>(
        std::lower_bound(ranges.begin(), ranges.end(), left) - ranges.begin());
    const auto last = static_cast<std::size_t>(
        std::upper_bound(ranges.begin(), ranges.end(), right) - ranges.begin());
    for (std::size_t j = first; j < last; ++j) {
      if (field.irregular) {
        if (depths[j] >= top && depths[j] <= bottom) serve(j, depths[j], field.column(j));
        continue;
      }
      const auto begin = static_cast<std::size_t>(
          std::lower_bound(depths.begin(), depths.end(), top) - depths.begin());
      for (std::size_t k = begin; k < depths.size() && depths[k] <= bottom; ++k)
        serve(j, depths[k], field.column(j) + k);
    }
  }
}

}  // namespace asdic
