#pragma once
#include <vector>

#include "raytrace/math/hermite.h"
#include "raytrace/ocean/environment.h"
#include "raytrace/tracing/boundary_hits.h"
#include "raytrace/tracing/cell_hits.h"

namespace asdic::detail {

/// Paths to the middles of cells of range, out of what two neighbouring rays of a fan strike.
class CellGrid {
 public:
  CellGrid(const Environment& environment, const GroundGrid& cells, double max_range,
           double frequency);

  /// Every cell between the hits of two rays: range and delay are cubics in the launch angle whose
  /// slopes are the rays' own; near a caustic the amplitude is held as in boundary_paths.h.
  void between(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
               const BoundaryHit& hb, std::vector<CellHit>& out) const;
  /// The same where slopes tell nothing of what lies between, over rough ground and between rays
  /// that are far apart: range by its chord, so that the tube between the two holds its energy;
  /// delay by its slopes over range.
  void along_chord(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                   const BoundaryHit& hb, std::vector<CellHit>& out) const;
  /// Whether the cubic through two hits rises, or falls, all the way between them or turns once, as
  /// at a caustic, by no more than it is long.
  [[nodiscard]] static bool is_tame(const StrikingRay& a, const BoundaryHit& ha,
                                    const StrikingRay& b, const BoundaryHit& hb) noexcept;

 private:
  void monotone(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                const BoundaryHit& hb, const Hermite& range, const Hermite& time, double from,
                double from_range, double to, double to_range, std::vector<CellHit>& out) const;
  [[nodiscard]] CellHit path(const StrikingRay& a, const BoundaryHit& ha, const StrikingRay& b,
                             const BoundaryHit& hb, const Hermite& range, double alpha,
                             double delay, std::uint32_t cell) const;

  GroundGrid cells_;
  double max_range_, frequency_;
  Spreading spreading_;
};

}  // namespace asdic::detail
