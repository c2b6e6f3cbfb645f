#pragma once
#include <span>

#include "raytrace/tracing/displace.h"
#include "raytrace/tracing/ocean.h"

namespace asdic::detail::tracing {

inline constexpr double widest_turn = 0.3;      ///< of the direction within one segment [rad]
inline constexpr double longest_segment = 2e4;  ///< [m]

/// One ray under way: from cell to cell, each segment ended by an event.
class March {
 public:
  March(const RayTracer::Ocean& ocean, const TraceLimits& limits, RayTrajectory& out) noexcept
      : ocean_(ocean), limits_(limits), out_(out) {}

  /// Segments are not stored, but told where they pass ranges.
  void tell(std::span<const double> ranges, RangeVisitor& visitor) noexcept {
    ranges_ = ranges;
    visitor_ = &visitor;
  }
  void run(double source_range, double source_depth, double launch_elevation);

 private:
  /// What may end a segment.
  enum class Event : unsigned char {
    none,     ///< an ordinary step
    row_top,  ///< a line of the water, or a flat boundary
    row_bottom,
    column_begin,  ///< a range of the section
    column_end,
    surface,  ///< a shaped surface
    bottom,
    turn,  ///< ζ = 0
    least_range,
    greatest_range,
    least_depth,
    greatest_depth,
  };

  [[nodiscard]] bool cross_rows();
  [[nodiscard]] double cross_by_invariant(double line);
  [[nodiscard]] double cross_by_series(double line);
  [[nodiscard]] bool stopped_before(double line, BoundaryKind kind) const;
  [[nodiscard]] bool clear_of(BoundaryKind kind, double sine, double turn) const;
  void enter(double depth);
  void enter_cell(std::size_t row, std::size_t column);
  [[nodiscard]] bool begin_step();
  void creep();
  [[nodiscard]] RayState crept(double way) const;
  void plan();
  void plan_closed(bool down, double longest);
  void plan_series(bool down, double longest);
  [[nodiscard]] double guess(bool down) const;
  [[nodiscard]] double to_facet_ahead(BoundaryKind kind, double time) const;
  void strike(BoundaryKind kind);
  [[nodiscard]] double hit(BoundaryKind kind, std::size_t facet, double in, double out) const;
  [[nodiscard]] double hit_between(BoundaryKind kind, std::size_t facet, double in,
                                   double out) const;
  [[nodiscard]] ValueSlope clearance(BoundaryKind kind, std::size_t facet, double h) const;
  [[nodiscard]] double step_to_range(double range, bool forward) const;
  [[nodiscard]] bool meets(BoundaryKind kind, double heading) const;
  void snap();
  void record();
  void keep();
  void store();
  void tell_ranges();
  [[nodiscard]] RayState passing(double range) const;
  [[nodiscard]] bool tells_between(double from, double to) const;
  [[nodiscard]] bool answer();
  [[nodiscard]] bool reflect_at(BoundaryKind kind);
  [[nodiscard]] bool displace_along(BoundaryKind kind, const RayState& in, const Local& water,
                                    const Tangent& hit, const BeamDisplacement& moved);
  [[nodiscard]] Tangent tangent_at(BoundaryKind kind) const noexcept;
  [[nodiscard]] const Boundary& boundary(BoundaryKind kind) const noexcept {
    return kind == BoundaryKind::surface ? ocean_.environment.surface : ocean_.environment.bottom;
  }
  [[nodiscard]] const Wall& wall(BoundaryKind kind) const noexcept {
    return kind == BoundaryKind::surface ? ocean_.surface : ocean_.bottom;
  }
  [[nodiscard]] std::size_t facet(BoundaryKind kind) const noexcept {
    return kind == BoundaryKind::surface ? surface_facet_ : bottom_facet_;
  }
  [[nodiscard]] std::size_t facet_ahead(BoundaryKind kind) const noexcept;
  [[nodiscard]] bool on_flat(BoundaryKind kind) const noexcept {
    return !boundary(kind).shape && y_.depth == boundary(kind).depth;
  }
  [[nodiscard]] bool end(RayEnd how) noexcept {
    out_.ended = how;
    return false;
  }

  const RayTracer::Ocean& ocean_;
  const TraceLimits& limits_;
  RayTrajectory& out_;

  RayState y_, next_;
  Local here_{}, there_{};  // of cell_, at y_ and next_
  const Cell* cell_ = nullptr;
  Course course_;
  std::size_t row_ = 0, column_ = 0, surface_facet_ = 0, bottom_facet_ = 0;
  bool near_surface_ = false, near_bottom_ = false;
  bool rising_ = false;       // ζ < 0 where the step begins
  bool crossed_row_ = false;  // the segment is one of cross_rows
  bool creeping_ = false;     // along a line of the water that bends the ray back to it
  RayHistory history_;
  double source_range_ = 0.0;
  double sense_ = 1.0;  // sign of q since the last caustic
  double step_ = 0.0;   // h of the step being taken
  Event event_ = Event::none;
  std::span<const double> ranges_;
  RangeVisitor* visitor_ = nullptr;
  std::size_t next_range_ = 0;  // the first not below y_
  int segments_ = 0;
  int touches_ = 0;  // reflections without way between them
};

}  // namespace asdic::detail::tracing
