#include "raytrace/tracing/cell_hits.h"

#include <algorithm>
#include <cmath>

#include "raytrace/math/hermite.h"
#include "raytrace/tracing/cell_grid.h"
#include "raytrace/tracing/fan_splitting.h"

namespace asdic::detail {
namespace {

/// Neighbours this close in launch angle are no longer resolved [rad].
constexpr double finest = 1e-12;

/// How well neighbours must tell what lies between them.
struct Tolerances {
  double range = 0.02;  ///< of a cell's width: of range and way
  /// What the mean grazing angle of two neighbours may miss that of the ray between by; halves are
  /// then right to a quarter of it [rad].
  double grazing = 4e-3;
};

/// Wide cells are asked for means over many places.
Tolerances tolerances_of(const GroundGrid& grid) noexcept {
  if (grid.wide() > grid.spacing()) return {.range = 0.1, .grazing = 0.02};
  return {};
}

/// What FanSplitting asks for.
class CellSearch {
 public:
  using Ray = StrikingRay;
  using Result = CellHit;
  static constexpr std::size_t coarse_levels = 0;

  CellSearch(const RayTracer& tracer, double source_depth, const GroundLevel& level,
             const GroundGrid& grid, double max_range, double frequency, const TraceLimits& limits)
      : tracer_(tracer),
        source_depth_(source_depth),
        level_(level),
        cells_(grid),
        tolerances_(tolerances_of(grid)),
        max_range_(max_range),
        limits_(limits),
        grid_(tracer.environment(), grid, max_range, frequency) {}

  void trace(double angle, StrikingRay& out) {
    tracer_.trace(0.0, source_depth_, angle, limits_, trajectory_);
    digest_hits(trajectory_, tracer_.environment(), level_, out);
  }

  [[nodiscard]] bool holds(const StrikingRay& a, const StrikingRay& m, const StrikingRay& b) const {
    if (b.angle - a.angle < finest) return true;
    const std::size_t hits = std::max({a.hits.size(), m.hits.size(), b.hits.size()});
    for (std::size_t i = 0; i < hits; ++i) {
      const bool together = i < a.hits.size() && i < m.hits.size() && i < b.hits.size() &&
                            a.hits[i].history == b.hits[i].history &&
                            a.hits[i].history == m.hits[i].history;
      if (!together) return parting_is_fine(a, m, b, i);
      const BoundaryHit &ha = a.hits[i], &hm = m.hits[i], &hb = b.hits[i];
      const double nearest = std::min({ha.range, hm.range, hb.range});
      if (nearest > max_range_) continue;
      const Hermite range({a.angle, ha.range, ha.d_range}, {b.angle, hb.range, hb.d_range});
      const Hermite time({a.angle, ha.time, ha.d_time}, {b.angle, hb.time, hb.d_time});
      // the slope tells what a lucky value does not
      const double off = std::abs(range.value(m.angle) - hm.range) +
                         std::abs(time.value(m.angle) - hm.time) * hm.speed +
                         std::abs(range.slope(m.angle) - hm.d_range) * (b.angle - a.angle) / 8.0;
      // halves are right to a sixteenth of that where all is smooth, and to about that elsewhere
      if (off > tolerances_.range * cells_.width_at(nearest)) return false;
      if (std::abs(0.5 * (ha.grazing + hb.grazing) - hm.grazing) > tolerances_.grazing)
        return false;
    }
    return true;
  }

  [[nodiscard]] double middle(const StrikingRay& a, const StrikingRay& b) const {
    return 0.5 * (a.angle + b.angle);
  }

  void search(const StrikingRay& a, const StrikingRay& b, std::vector<CellHit>& out) const {
    const std::size_t hits = std::min(a.hits.size(), b.hits.size());
    for (std::size_t i = 0; i < hits && a.hits[i].history == b.hits[i].history; ++i)
      grid_.between(a, a.hits[i], b, b.hits[i], out);
  }

 private:
  /// Histories part: at a node of the boundary, or where a ray turns just before it. What is lost
  /// between two rays is less than a cell's small part.
  [[nodiscard]] bool parting_is_fine(const StrikingRay& a, const StrikingRay& m,
                                     const StrikingRay& b, std::size_t i) const {
    double nearest = 1e300;
    int stopped = 0;
    for (const StrikingRay* ray : {&a, &m, &b}) {
      if (i < ray->hits.size())
        nearest = std::min(nearest, ray->hits[i].range);
      else if (ray->ended == RayEnd::faint || ray->ended == RayEnd::absorbed ||
               ray->ended == RayEnd::bounces)
        ++stopped;
    }
    if (nearest > max_range_ || stopped >= 2) return true;
    return std::max(a.widest, b.widest) * (b.angle - a.angle) <
           tolerances_.range * cells_.width_at(std::max(0.0, nearest));
  }

  const RayTracer& tracer_;
  double source_depth_;
  GroundLevel level_;
  GroundGrid cells_;
  Tolerances tolerances_;
  double max_range_;
  TraceLimits limits_;
  CellGrid grid_;
  RayTrajectory trajectory_;
};

}  // namespace

std::vector<CellHit> hits_on_cells(const RayTracer& tracer, double source_depth,
                                   const GroundLevel& level, const GroundGrid& grid,
                                   double max_range, double frequency, const FanLimits& limits,
                                   SearchWatch* watch) {
  // As many bounces before the hit as allowed: a hit on a boundary is itself one more.
  TraceLimits trace{.max_range = max_range + grid.wide(),
                    .min_depth = limits.min_depth,
                    .max_depth = limits.max_depth,
                    .max_surface_bounces = limits.max_surface_bounces,
                    .max_bottom_bounces = limits.max_bottom_bounces,
                    .faintest = limits.faintest};
  if (level.boundary)
    ++(*level.boundary == BoundaryKind::surface ? trace.max_surface_bounces
                                                : trace.max_bottom_bounces);
  trace.min_range = -max_range;
  const FanSplitting<CellSearch> fan(limits.lowest, limits.highest);
  return fan.run(
      [&] { return CellSearch(tracer, source_depth, level, grid, max_range, frequency, trace); },
      watch);
}

}  // namespace asdic::detail
