#pragma once
#include <array>

#include "raytrace/tracing/displace.h"
#include "raytrace/tracing/ocean.h"

namespace asdic::tracing {

/// One ray under way: from cell to cell, each segment ended by an event.
class March {
 public:
  March(const RayTracer::Ocean& ocean, const TraceLimits& limits, RayTrajectory& out) noexcept
      : ocean_(ocean), limits_(limits), out_(out) {}

  void run(double source_range, double source_depth, double launch_elevation);

 private:
  /// What may end a segment. Each has a value that is positive before and zero at the event.
  enum class Event : unsigned char {
    none,     ///< an ordinary step
    row_top,  ///< a line of the water, or a flat boundary
    row_bottom,
    column_begin,  ///< a range of the section
    column_end,
    surface_begin,  ///< a node of the surface's shape
    surface_end,
    bottom_begin,
    bottom_end,
    surface,  ///< a shaped surface
    bottom,
    turn,  ///< ζ = 0
    least_range,
    greatest_range,
    greatest_depth,
  };

  void enter(double depth);
  [[nodiscard]] bool begin_step();
  void creep();
  void plan();
  void take_general_step();
  void find_events();
  [[nodiscard]] double value(Event event, const RayState& y) const noexcept;
  [[nodiscard]] double rate(Event event, const RayState& y) const noexcept;
  void shrink_to(Event event, double low, double high);
  void dipped(Event event);
  void snap();
  void record();
  [[nodiscard]] bool answer();
  [[nodiscard]] bool reflect_at(BoundaryKind kind);
  [[nodiscard]] bool displace_along(BoundaryKind kind, const RayState& in, const Local& water,
                                    const Tangent& hit, const BeamDisplacement& moved);
  [[nodiscard]] Tangent tangent_at(BoundaryKind kind) const noexcept;
  [[nodiscard]] const Boundary& boundary(BoundaryKind kind) const noexcept {
    return kind == BoundaryKind::surface ? ocean_.environment.surface : ocean_.environment.bottom;
  }
  [[nodiscard]] bool on_flat(BoundaryKind kind) const noexcept;
  [[nodiscard]] bool end(RayEnd how) noexcept {
    out_.ended = how;
    return false;
  }

  const RayTracer::Ocean& ocean_;
  const TraceLimits& limits_;
  RayTrajectory& out_;

  RayState y_, next_;
  Local here_{};
  Cell cell_{};
  std::size_t row_ = 0, column_ = 0, surface_facet_ = 0, bottom_facet_ = 0;
  bool near_surface_ = false, near_bottom_ = false;
  bool creeping_ = false;  // along a line of the water that bends the ray back to it
  RayHistory history_;
  double source_range_ = 0.0;
  double sense_ = 1.0;          // sign of q since the last caustic
  double turn_sense_ = 0.0;     // sign of ζ at the step's begin
  double step_ = 0.0;           // h of the step being taken
  double general_step_ = 50.0;  // what the error control last found right
  Event event_ = Event::none;
  int touches_ = 0;  // reflections without way between them
};

}  // namespace asdic::tracing
