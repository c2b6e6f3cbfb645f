#include "raytrace/tracing/marching_eigenrays.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/level_rays.h"
#include "raytrace/ocean/speed_extremes.h"
#include "raytrace/tracing/fan_splitting.h"
#include "raytrace/tracing/neighbours.h"
#include "raytrace/tracing/root_finder.h"

namespace asdic::detail {
namespace {

/// A receiver (almost) straight above or below is met by (almost) vertical rays; they are found at
/// this range and then put upright, as in the layered solver (eigenrays.cpp) [m].
constexpr double least_range = 0.1;

/// Roots closer than this are one [rad, s].
constexpr double same_root = 1e-9;

/// The range up to which a boundary closes in on the water anywhere. A ray that runs away from the
/// source is made shallower where it opens, so only before this can slopes send it back.
double closes_up_to(const BoundaryShape& shape, BoundaryKind kind) {
  const double closing = kind == BoundaryKind::bottom ? -1.0 : 1.0;  // sign of the slope
  for (std::size_t i = shape.facets() - 1; i-- > 1;) {
    const double begin = shape.facet_begin(i), end = shape.facet_end(i);
    const double rise = shape.depth_at(end, i) - shape.depth_at(begin, i);
    if (closing * rise > 0.0) return end;
    for (const double share : {0.0, 0.5, 1.0})
      if (closing * shape.at(std::lerp(begin, end, share), i).slope > 0.0) return end;
  }
  return -1e300;
}

/// Water between the shallowest and the deepest place of the boundaries.
struct WaterSpan {
  double top, bottom;

  explicit WaterSpan(const Environment& ocean)
      : top(ocean.surface.shape ? ocean.surface.shape->shallowest() : ocean.surface.depth),
        bottom(ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth) {}
  [[nodiscard]] double thickness() const noexcept { return bottom - top; }
};

/// The furthest that a ray goes beyond a range to which slopes send it back [m].
///
/// A bounce off a slope s changes the horizontal slowness ξ by at most 2s/c, and nothing else does
/// where water does not vary with range. A ray that comes back after N bounces therefore has
/// |ξ| ≤ 2sN/c all the time that it is beyond, which is |cos θ| = |ξ|c ≤ κ. It crosses the water at
/// most N + 1 times, by κ/√(1 − κ²) of the thickness each. Infinity where κ does not make it steep.
double turned_back_within(const RayTracer& tracer, const WaterSpan& water,
                          const FanLimits& limits) {
  const double bounces = double(limits.max_surface_bounces) + double(limits.max_bottom_bounces);
  const double bends =
      2.0 * (tracer.steepest_slope(BoundaryKind::surface) * limits.max_surface_bounces +
             tracer.steepest_slope(BoundaryKind::bottom) * limits.max_bottom_bounces);
  const Environment& ocean = tracer.environment();
  if (bends == 0.0 || ocean.section) return bends == 0.0 ? 0.0 : infinity;
  const auto [slowest, fastest] = speed_extremes(ocean.water, water.top, water.bottom);
  constexpr double steep = 0.5;
  const double kappa = bends * fastest / slowest;
  if (!(kappa < steep)) return infinity;
  return (bounces + 1.0) * water.thickness() * kappa / std::sqrt(1.0 - kappa * kappa);
}

/// Ranges between which rays are followed: from the first node, as far behind the last column as
/// there are slopes that can send a ray back, and until the next boundary is met, mostly.
struct FollowedRanges {
  double from, to;  // [m]
};
FollowedRanges followed_ranges(const RayTracer& tracer, double first, double last,
                               const FanLimits& limits) {
  const Environment& ocean = tracer.environment();
  const WaterSpan water(ocean);
  const double back = turned_back_within(tracer, water, limits);
  FollowedRanges ranges{.from = first, .to = last};
  for (const auto kind : {BoundaryKind::surface, BoundaryKind::bottom}) {
    const auto& shape = (kind == BoundaryKind::surface ? ocean.surface : ocean.bottom).shape;
    if (!shape) continue;
    ranges.from = std::min(ranges.from, shape->ranges().front());
    ranges.to = std::max(ranges.to, closes_up_to(*shape, kind));
  }
  return {.from = std::max(ranges.from, first - back) - 1.0,
          .to = std::max(std::min(ranges.to, last + back), last + water.thickness())};
}

struct Hit {
  std::uint32_t receiver;
  Arrival path;
};

TraceLimits trace_limits(const RayTracer& tracer, double source_range,
                         std::span<const ReceiverColumn> columns, const FanLimits& limits) {
  const double first = std::min(source_range, columns.front().range);
  const double last = std::max(source_range, columns.back().range);
  TraceLimits trace{.min_depth = limits.min_depth,
                    .max_depth = limits.max_depth,
                    .max_surface_bounces = limits.max_surface_bounces,
                    .max_bottom_bounces = limits.max_bottom_bounces,
                    .faintest = limits.faintest};
  const FollowedRanges ranges = followed_ranges(tracer, first, last, limits);
  trace.max_range = std::min(limits.max_range, ranges.to);
  trace.max_range = std::max(trace.max_range, last + 1.0);  // the edge of the box is in it
  trace.min_range = std::max(limits.min_range, ranges.from);
  return trace;
}

/// What FanSplitting asks for, for receivers in columns.
struct ColumnSearch {
  using Ray = FanRay;
  using Result = Hit;
  static constexpr std::size_t coarse_levels = 3;

  ColumnSearch(const RayTracer& tracer, double source_range, double source_depth,
               const TraceLimits& limits, std::span<const ReceiverColumn> columns, int max_turns)
      : tracer_(tracer),
        source_range_(source_range),
        source_depth_(source_depth),
        limits_(limits),
        columns_(columns),
        max_turns_(max_turns),
        level_(level_rays(tracer.environment(), tracer.frequency(), source_range, source_depth)),
        level_paths_(
            level_paths(tracer.environment(), tracer.frequency(), source_range, source_depth)),
        test_(tracer.environment(), columns),
        roots_(tracer, source_range, source_depth, limits, columns) {}

  void trace(double angle, FanRay& out) {
    const bool along_kink = level_.angle > 0.0 && angle == 0.0;
    const double depth = along_kink ? level_.depth : source_depth_;
    tracer_.trace(source_range_, depth, angle, limits_, trajectory_);
    cost_.add(trajectory_.segments.size());
    digest(trajectory_, tracer_.environment(), columns_, out);
  }
  [[nodiscard]] SearchCost cost() const noexcept {
    SearchCost all = cost_;
    return all += roots_.cost();
  }
  [[nodiscard]] bool holds(const FanRay& a, const FanRay& m, const FanRay& b) const {
    return level(a, b) || test_.holds(a, m, b);
  }
  [[nodiscard]] bool pair_tells(const FanRay& a, const FanRay& b) const {
    return level(a, b) || test_.pair_tells(a, b);
  }
  [[nodiscard]] bool regular(const FanRay& a, const FanRay& m, const FanRay& b) const {
    return level(a, b) || test_.regular(a, m, b);
  }
  [[nodiscard]] double middle(const FanRay& a, const FanRay& b) const {
    for (const double edge : {-level_.angle, level_.angle})
      if (a.angle < edge && edge < b.angle) return edge;
    return splitting_angle(a, b, tracer_.environment());
  }
  void search(const FanRay& a, const FanRay& b, std::vector<Hit>& out) {
    const RootFinder::Found found = [&](std::uint32_t receiver, Arrival&& path) {
      out.push_back({receiver, std::move(path)});
    };
    if (level(a, b)) return roots_.search_level(a, b, level_paths_, max_turns_, found);
    roots_.search(a, b, max_turns_, found);
  }

 private:
  /// Whether two rays are no further apart than a fan tells them (LevelRays).
  [[nodiscard]] bool level(const FanRay& a, const FanRay& b) const noexcept {
    return level_.angle > 0.0 && a.angle >= -level_.angle && b.angle <= level_.angle;
  }

  const RayTracer& tracer_;
  double source_range_, source_depth_;
  TraceLimits limits_;
  std::span<const ReceiverColumn> columns_;
  int max_turns_;
  LevelRays level_;
  LevelRays level_paths_;  // for receivers that the level ray reaches
  NeighbourTest test_;
  RootFinder roots_;
  RayTrajectory trajectory_;
  SearchCost cost_;
};

void sort_and_drop_doubles(Arrivals& arrivals) {
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return a.delay != b.delay ? a.delay < b.delay : a.launch_elevation < b.launch_elevation;
  });
  const auto same = [](const Arrival& a, const Arrival& b) {
    return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
           std::abs(a.launch_elevation - b.launch_elevation) < same_root &&
           std::abs(a.delay - b.delay) < same_root;
  };
  arrivals.erase(std::unique(arrivals.begin(), arrivals.end(), same), arrivals.end());
}

/// A path found at the least range, for a receiver closer to the vertical: every horizontal step
/// shrinks in proportion.
void raise(Arrival& path, double share) {
  path.horizontal_slowness *= share;
  for (double* angle : {&path.launch_elevation, &path.arrival_elevation})
    *angle = std::copysign(std::acos(share * std::cos(*angle)), *angle);
  for (Bounce& bounce : path.bounces) bounce.range *= share;
}

}  // namespace

std::vector<Arrivals> marching_eigenrays(const RayTracer& tracer, double source_range,
                                         double source_depth,
                                         std::span<const ReceiverPoint> receivers,
                                         const FanLimits& limits, SearchWatch* watch) {
  std::vector<Arrivals> found(receivers.size());
  if (receivers.empty()) return found;
  std::vector<ReceiverPoint> points(receivers.begin(), receivers.end());
  for (ReceiverPoint& point : points)
    if (std::abs(point.range - source_range) < least_range)
      point.range = source_range + least_range;
  const std::vector<ReceiverColumn> columns = make_columns(points);
  const TraceLimits trace = trace_limits(tracer, source_range, columns, limits);
  const FanSplitting<ColumnSearch> fan(limits.lowest, limits.highest);
  const auto work = [&] {
    return ColumnSearch(tracer, source_range, source_depth, trace, columns, limits.max_turns);
  };
  for (Hit& hit : fan.run(work, watch)) {
    const double offset = std::abs(receivers[hit.receiver].range - source_range);
    if (offset < least_range) raise(hit.path, offset / least_range);
    found[hit.receiver].push_back(std::move(hit.path));
  }
  const LevelRays level =
      level_paths(tracer.environment(), tracer.frequency(), source_range, source_depth);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (level.angle > 0.0 && std::abs(receivers[i].depth - source_depth) <= level.height)
      merge_level_paths(level, found[i]);
    sort_and_drop_doubles(found[i]);
  }
  return found;
}

}  // namespace asdic::detail
