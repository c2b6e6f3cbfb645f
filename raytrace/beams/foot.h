#pragma once
#include <algorithm>
#include <cmath>

#include "raytrace/beams/beam.h"
#include "raytrace/tracing/segment_states.h"

namespace asdic::detail {

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
  const double c = 1.0 / std::sqrt(state.xi * state.xi + state.zeta * state.zeta);
  const double dr = range - state.range, dz = depth - state.depth;
  return {c * (dr * state.xi + dz * state.zeta), c * (dz * state.xi - dr * state.zeta)};
}

/// The arc length from the segment's begin at which the ray's normal passes through the receiver,
/// which lies `ahead` of the begin and `behind` the end. By secants within the bracket; the
/// function is a straight line but for the ray's curvature, so two or three reach a micrometre.
inline double foot_arc(const SegmentStates& states, double length, double range, double depth,
                       double ahead, double behind) noexcept {
  double low = 0.0, high = length;
  double slope = (behind - ahead) / high;
  double s = -ahead / slope, last_s = 0.0, last = ahead;
  for (int i = 0; i < 60; ++i) {
    const SegmentStates::Place at = states.place(s);
    const double miss = (range - at.range) * at.range_slope + (depth - at.depth) * at.depth_slope;
    if (std::abs(miss) < 1e-6 || high - low < 1e-7) break;
    (miss >= 0.0 ? low : high) = s;
    if (s != last_s && (miss - last) / (s - last_s) < 0.0) slope = (miss - last) / (s - last_s);
    last_s = s;
    last = miss;
    s -= miss / slope;
    if (!(s > low && s < high)) s = 0.5 * (low + high);
  }
  return s;
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
    const SegmentStates states(segment);
    const auto serve = [&](std::size_t column, double depth, std::complex<double>* sum) {
      const double range = ranges[column];
      depth = image(depth);
      const double ahead = beams::ray_coordinates(from, range, depth).along;
      const double behind = beams::ray_coordinates(to, range, depth).along;
      if (!(ahead >= 0.0 && behind < 0.0)) return;
      Foot foot{.segment = &segment,
                .state = states.at(
                    beams::foot_arc(states, to.length - from.length, range, depth, ahead, behind)),
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
    if (field.irregular) {
      for (std::size_t j = first; j < last; ++j)
        if (depths[j] >= top && depths[j] <= bottom) serve(j, depths[j], field.column(j));
      continue;
    }
    // Where the normals of begin and end cross a row: its receivers between them are those in
    // question.
    const bool steep = from.xi * to.xi <= 0.0 || cosine < 0.01;
    const double slope_from = from.zeta / from.xi, slope_to = to.zeta / to.xi;
    const auto row = std::lower_bound(depths.begin(), depths.end(), top);
    for (auto k = static_cast<std::size_t>(row - depths.begin());
         k < depths.size() && depths[k] <= bottom; ++k) {
      std::size_t j = first, end = last;
      if (!steep) {
        const double depth = image(depths[k]);
        const double a = from.range - (depth - from.depth) * slope_from;
        const double b = to.range - (depth - to.depth) * slope_to;
        const auto least = ranges.begin() + static_cast<std::ptrdiff_t>(first);
        const auto most = ranges.begin() + static_cast<std::ptrdiff_t>(last);
        const double slack = 1e-9 * (std::abs(a) + std::abs(b));
        j = static_cast<std::size_t>(std::lower_bound(least, most, std::min(a, b) - slack) -
                                     ranges.begin());
        end = static_cast<std::size_t>(std::upper_bound(least, most, std::max(a, b) + slack) -
                                       ranges.begin());
      }
      for (; j < end; ++j) serve(j, depths[k], field.column(j) + k);
    }
  }
}

}  // namespace asdic::detail
