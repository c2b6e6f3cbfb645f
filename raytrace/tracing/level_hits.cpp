#include "raytrace/tracing/level_hits.h"

#include <algorithm>
#include <cmath>

#include "raytrace/parallel/stop.h"
#include "raytrace/tracing/cell_grid.h"

namespace asdic::detail {
namespace {

/// What a hit is, whatever facets were struck before: the bounces, the way it goes, and how many
/// such hits came before.
struct HitKind {
  int surface_bounces, bottom_bounces;
  bool down;
  bool operator==(const HitKind&) const = default;
};
HitKind kind_of(const BoundaryHit& hit) noexcept {
  return {hit.surface_bounces, hit.bottom_bounces, hit.down > 0.0};
}

/// Adds the paths between two neighbours to one level.
class TubeFiller {
 public:
  TubeFiller(const Environment& environment, const GroundGrid& cells, double max_range,
             double frequency, const FanLimits& limits)
      : grid_(environment, cells, max_range, frequency), max_range_(max_range), limits_(limits) {}

  void fill(const StrikingRay& a, const StrikingRay& b, std::vector<CellHit>& out) {
    met_.assign(b.hits.size(), false);
    for (const BoundaryHit& ha : a.hits) {
      if (ha.surface_bounces > limits_.max_surface_bounces ||
          ha.bottom_bounces > limits_.max_bottom_bounces)
        continue;
      for (std::size_t j = 0; j < b.hits.size(); ++j) {
        const BoundaryHit& hb = b.hits[j];
        if (met_[j] || !(kind_of(hb) == kind_of(ha))) continue;
        met_[j] = true;
        if (hb.history == ha.history && CellGrid::is_tame(a, ha, b, hb))
          grid_.between(a, ha, b, hb, out);
        else if (std::abs(hb.range - ha.range) < longest * max_range_)
          grid_.along_chord(a, ha, b, hb, out);
        break;
      }
    }
  }

 private:
  static constexpr double longest = 0.1;  // of the range: beyond, the two are not of one kind
  CellGrid grid_;
  double max_range_;
  FanLimits limits_;
  std::vector<bool> met_;  // of the second ray's hits
};

/// Launch angles between −1 and 1, twice denser about the middle.
double place(int i, int rays) noexcept {
  const double v = 2.0 * i / (rays - 1) - 1.0;
  return v * (0.5 + 0.5 * v * v);
}

}  // namespace

std::vector<std::vector<CellHit>> hits_on_levels(const RayTracer& tracer, double source_depth,
                                                 std::span<const GroundLevel> levels,
                                                 const GroundGrid& cells, double max_range,
                                                 double frequency, const FanLimits& limits,
                                                 int rays) {
  // A hit on a boundary is itself one more bounce.
  const TraceLimits trace{.min_range = -max_range,
                          .max_range = max_range + cells.wide(),
                          .min_depth = limits.min_depth,
                          .max_depth = limits.max_depth,
                          .max_surface_bounces = limits.max_surface_bounces + 1,
                          .max_bottom_bounces = limits.max_bottom_bounces + 1,
                          .faintest = limits.faintest};
  std::vector<std::vector<CellHit>> found(levels.size());
  std::vector<StrikingRay> before(levels.size()), now(levels.size());
  TubeFiller filler(tracer.environment(), cells, max_range, frequency, limits);
  RayTrajectory trajectory;
  for (int i = 0; i < rays; ++i) {
    stop_point();
    const double angle = std::lerp(limits.lowest, limits.highest, 0.5 + 0.5 * place(i, rays));
    tracer.trace(0.0, source_depth, angle, trace, trajectory);
    for (std::size_t k = 0; k < levels.size(); ++k) {
      digest_hits(trajectory, tracer.environment(), levels[k], now[k]);
      if (i > 0) filler.fill(before[k], now[k], found[k]);
    }
    std::swap(before, now);
  }
  return found;
}

}  // namespace asdic::detail
