#include "raytrace/tracing/cell_hits.h"

#include <algorithm>
#include <cmath>

#include "raytrace/math/hermite.h"
#include "raytrace/math/monotone_root.h"
#include "raytrace/ocean/tube_amplitude.h"
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

HermiteNode range_node(const StrikingRay& ray, const BoundaryHit& hit) {
  return {ray.angle, hit.range, hit.d_range};
}
HermiteNode time_node(const StrikingRay& ray, const BoundaryHit& hit) {
  return {ray.angle, hit.time, hit.d_time};
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
        grid_(grid),
        tolerances_(tolerances_of(grid)),
        max_range_(max_range),
        frequency_(frequency),
        limits_(limits),
        spreading_(spreading_across(tracer.environment())) {}

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
      const Hermite range(range_node(a, ha), range_node(b, hb));
      const Hermite time(time_node(a, ha), time_node(b, hb));
      // the slope tells what a lucky value does not
      const double off = std::abs(range.value(m.angle) - hm.range) +
                         std::abs(time.value(m.angle) - hm.time) * hm.speed +
                         std::abs(range.slope(m.angle) - hm.d_range) * (b.angle - a.angle) / 8.0;
      // halves are right to a sixteenth of that where all is smooth, and to about that elsewhere
      if (off > tolerances_.range * grid_.width_at(nearest)) return false;
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
      grid_paths(a, a.hits[i], b, b.hits[i], out);
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
           tolerances_.range * grid_.width_at(std::max(0.0, nearest));
  }

  /// Every cell centre between the hits of two rays.
  void grid_paths(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                  const BoundaryHit& hb, std::vector<CellHit>& out) const {
    const Hermite range(range_node(a, ha), range_node(b, hb));
    const Hermite time(time_node(a, ha), time_node(b, hb));
    const bool caustic = (ha.d_range > 0.0) != (hb.d_range > 0.0);
    const auto turns = caustic ? range.extrema() : Hermite::Places{};
    double from = a.angle, from_range = ha.range;
    for (std::size_t i = 0; i <= turns.size(); ++i) {
      const double to = i < turns.size() ? turns.x[i] : b.angle;
      const double to_range = i < turns.size() ? range.value(to) : hb.range;
      grid_monotone(a, ha, b, hb, range, time, from, from_range, to, to_range, out);
      from = to;
      from_range = to_range;
    }
  }

  void grid_monotone(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                     const BoundaryHit& hb, const Hermite& range, const Hermite& time, double from,
                     double from_range, double to, double to_range,
                     std::vector<CellHit>& out) const {
    const bool rising = to_range > from_range;
    const double near = rising ? from : to, far = rising ? to : from;
    const double near_range = std::min(from_range, to_range);
    const double limit = std::min(std::max(from_range, to_range), max_range_);
    double alpha = near;
    for (auto cell = static_cast<std::uint32_t>(grid_.count(std::max(0.0, near_range)));; ++cell) {
      const double r = grid_.range(cell);
      if (r >= limit) return;
      alpha = monotone_root(range, r, std::min(near, far), std::max(near, far), rising, alpha,
                            1e-3 * grid_.spacing());  // from the neighbour's
      out.push_back(path(a, ha, b, hb, range, alpha, time.value(alpha), cell));
    }
  }

  CellHit path(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
               const BoundaryHit& hb, const Hermite& range, double alpha, double delay,
               std::uint32_t cell) const {
    const double u = (alpha - a.angle) / (b.angle - a.angle);
    const auto between = [u](double x, double y) { return x + u * (y - x); };
    const double slope = range.slope(alpha);
    // Where two rays coalesce: the least |∂r/∂α| = |dr/dξ|·|dξ/dα|, ξ the slowness along the
    // boundary.
    // The cubic's slope is a parabola; its bend where that is zero, if it is anywhere. At a
    // limiting ray, where dr/dα goes to infinity and no caustic is, it is nowhere.
    const double bend_a = range.bend(a.angle), width = b.angle - a.angle;
    const double third = (range.bend(b.angle) - bend_a) / width;
    const double bend = std::sqrt(std::max(0.0, bend_a * bend_a - 2.0 * third * ha.d_range));
    const double turn = (hb.slowness - ha.slowness) / width;
    const double floor =
        turn != 0.0 ? airy_floor(bend / (turn * turn), frequency_) * std::abs(turn) : 0.0;
    const double q = std::max(std::abs(slope), floor) * between(ha.q_per_d_range, hb.q_per_d_range);
    const double r = grid_.range(cell);
    const double spreading = tube_amplitude(
        spreading_, {.speed = between(ha.speed, hb.speed),
                     .q = q,
                     .range = r,
                     .launch_slowness = launch_slowness(alpha, a.source_speed),
                     .speed_integral = r / std::abs(between(ha.mean_slowness, hb.mean_slowness))});
    const bool like_a = (slope > 0.0) == (ha.d_range > 0.0);
    CellHit hit;
    hit.cell = cell;
    hit.launch_elevation = alpha;
    hit.delay = delay;
    hit.grazing = between(ha.grazing, hb.grazing);
    hit.slowness = between(ha.slowness, hb.slowness);
    hit.length = delay * between(ha.length / ha.time, hb.length / hb.time);  // by the mean speed
    hit.down = ha.down;
    hit.surface_bounces = ha.surface_bounces;
    hit.bottom_bounces = ha.bottom_bounces;
    hit.amplitude = path_amplitude(spreading, std::exp(-between(ha.nepers, hb.nepers)),
                                   ha.reflection + u * (hb.reflection - ha.reflection),
                                   like_a ? ha.caustics : hb.caustics);
    return hit;
  }

  const RayTracer& tracer_;
  double source_depth_;
  GroundLevel level_;
  GroundGrid grid_;
  Tolerances tolerances_;
  double max_range_, frequency_;
  TraceLimits limits_;
  Spreading spreading_;
  RayTrajectory trajectory_;
};

}  // namespace

std::vector<CellHit> hits_on_cells(const RayTracer& tracer, double source_depth,
                                   const GroundLevel& level, const GroundGrid& grid,
                                   double max_range, double frequency, const FanLimits& limits) {
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
      [&] { return CellSearch(tracer, source_depth, level, grid, max_range, frequency, trace); });
}

}  // namespace asdic::detail
