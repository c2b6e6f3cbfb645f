#include "raytrace/tracing/level_hits.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Between two neighbours, the paths to one level.
class TubeFiller {
 public:
  TubeFiller(const Environment& environment, const GroundGrid& cells, double max_range,
             double frequency, const FanLimits& limits)
      : grid_(environment, cells, max_range, frequency), max_range_(max_range), limits_(limits) {}

  /// Whether strong hits of one have no like in the other: a ray that turns beside one that is
  /// reflected, and between them those that go far along the boundary.
  [[nodiscard]] bool part(const StrikingRay& a, const StrikingRay& b) const {
    const auto alone = [&](const StrikingRay& from, const StrikingRay& to) {
      return std::any_of(from.hits.begin(), from.hits.end(), [&](const BoundaryHit& hit) {
        if (!counts(hit) || std::abs(hit.reflection) < strong) return false;
        return std::none_of(to.hits.begin(), to.hits.end(), [&](const BoundaryHit& other) {
          return kind_of(other) == kind_of(hit) && near(hit, other);
        });
      });
    };
    return alone(a, b) || alone(b, a);
  }

  void fill(const StrikingRay& a, const StrikingRay& b, std::vector<CellHit>& out) {
    met_.assign(b.hits.size(), false);
    for (const BoundaryHit& ha : a.hits) {
      if (!counts(ha)) continue;
      for (std::size_t j = 0; j < b.hits.size(); ++j) {
        const BoundaryHit& hb = b.hits[j];
        if (met_[j] || !(kind_of(hb) == kind_of(ha))) continue;
        met_[j] = true;
        if (hb.history == ha.history && CellGrid::is_tame(a, ha, b, hb))
          grid_.between(a, ha, b, hb, out);
        else if (near(ha, hb))
          grid_.along_chord(a, ha, b, hb, out);
        break;
      }
    }
  }

 private:
  static constexpr double longest = 0.1;  // of the range: beyond, the two are not of one kind
  static constexpr double strong = 0.1;   // product of reflections
  [[nodiscard]] bool counts(const BoundaryHit& hit) const {
    return hit.surface_bounces <= limits_.max_surface_bounces &&
           hit.bottom_bounces <= limits_.max_bottom_bounces && hit.range < max_range_;
  }
  [[nodiscard]] bool near(const BoundaryHit& a, const BoundaryHit& b) const {
    return std::abs(a.range - b.range) < longest * max_range_;
  }

  CellGrid grid_;
  double max_range_;
  FanLimits limits_;
  std::vector<bool> met_;  // of the second ray's hits
};

/// One fan: every ray is traced once and serves all levels.
class LevelFan {
 public:
  LevelFan(const RayTracer& tracer, double source_depth, std::span<const GroundLevel> levels,
           const TraceLimits& trace, TubeFiller filler)
      : tracer_(tracer),
        source_depth_(source_depth),
        levels_(levels),
        trace_(trace),
        filler_(std::move(filler)),
        found_(levels.size()) {}

  using Rays = std::vector<StrikingRay>;  // of one launch angle, [levels]

  [[nodiscard]] Rays at(double angle) {
    stop_point();
    tracer_.trace(0.0, source_depth_, angle, trace_, trajectory_);
    Rays rays(levels_.size());
    for (std::size_t k = 0; k < levels_.size(); ++k)
      digest_hits(trajectory_, tracer_.environment(), levels_[k], rays[k]);
    return rays;
  }

  /// Takes what lies between two neighbours; halves them where strong paths begin or end.
  void between(const Rays& a, const Rays& b, int halvings) {
    bool part = false;
    for (std::size_t k = 0; k < levels_.size() && !part; ++k) part = filler_.part(a[k], b[k]);
    if (part && halvings > 0) {
      const Rays middle = at(0.5 * (a[0].angle + b[0].angle));
      between(a, middle, halvings - 1);
      between(middle, b, halvings - 1);
      return;
    }
    for (std::size_t k = 0; k < levels_.size(); ++k) filler_.fill(a[k], b[k], found_[k]);
  }

  [[nodiscard]] std::vector<std::vector<CellHit>> take() { return std::move(found_); }

 private:
  const RayTracer& tracer_;
  double source_depth_;
  std::span<const GroundLevel> levels_;
  TraceLimits trace_;
  TubeFiller filler_;
  std::vector<std::vector<CellHit>> found_;
  RayTrajectory trajectory_;
};

/// A level so near to the source's depth that halved rays of a fan would miss its far cells: adds
/// rays that meet it along straight lines, from cell to cell at first and in tenths of the range at
/// last. \param below  the source [m]
void aim_along(double below, const GroundGrid& cells, double max_range, const FanLimits& limits,
               std::vector<double>& angles) {
  constexpr double resolved = 2e-3;  // of halved rays, some of them [rad]
  constexpr double factor = 1.3, most = 0.05;
  if (std::abs(below) > resolved * max_range) return;
  for (double range = std::max(cells.wide(), std::abs(below)); range < factor * max_range;
       range = std::min(factor * range, range + most * max_range)) {
    const double angle = std::atan2(-below, range);
    if (angle > limits.lowest && angle < limits.highest) angles.push_back(angle);
  }
}

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
  constexpr int halvings = 5;
  LevelFan fan(tracer, source_depth, levels, trace,
               TubeFiller(tracer.environment(), cells, max_range, frequency, limits));
  std::vector<double> angles;
  for (int i = 0; i < rays; ++i)
    angles.push_back(std::lerp(limits.lowest, limits.highest, 0.5 + 0.5 * place(i, rays)));
  for (const GroundLevel& level : levels)
    if (!level.boundary) aim_along(level.depth - source_depth, cells, max_range, limits, angles);
  std::sort(angles.begin(), angles.end());
  LevelFan::Rays before;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    LevelFan::Rays now = fan.at(angles[i]);
    if (i > 0) fan.between(before, now, halvings);
    before = std::move(now);
  }
  return fan.take();
}

}  // namespace asdic::detail
