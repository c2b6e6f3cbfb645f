#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/tracing/ray_tracer.h"
#include "raytrace/tracing/receiver_columns.h"

namespace asdic::detail {

/// Where a ray crosses the column of a range, and how that depth moves when the ray is launched a
/// little higher.
struct ColumnCrossing {
  double depth = 0.0;   ///< z [m]
  double slope = 0.0;   ///< ∂z/∂α at fixed range, α the launch elevation [m/rad]
  double cosine = 1.0;  ///< |cos θ| there: a miss in depth times this is the distance to the ray
  int turns = 0;        ///< turning points passed
};

/// A leg of a trajectory: its segments [first, last), and a number that rays share which have hit
/// the same boundaries, and facets of them where the tangent jumps, in the same order before.
struct LegOfRay {
  std::uint64_t history = 0;
  std::size_t first = 0, last = 0;
};

/// The history after one more bounce.
[[nodiscard]] std::uint64_t history_after(std::uint64_t history, const Boundary& boundary,
                                          BoundaryKind kind, double range) noexcept;

/// \param out  its memory is reused
void split_into_legs(const RayTrajectory& ray, const Environment& environment,
                     std::vector<LegOfRay>& out);

/// (−1)^(bounces): after an odd number of bounces the beam is seen in a mirror, and the ray
/// launched a little higher is on the other side.
[[nodiscard]] double mirror_sign(const RayHistory& history) noexcept;

/// The state of a ray at one end of a leg, with the water's gradient: enough to go a little further
/// along the leg's own curve, as if the boundary were not there.
struct LegEnd {
  double range = 0.0, depth = 0.0, xi = 0.0, zeta = 0.0, q = 0.0, p = 0.0;
  double c = 1.0, c_r = 0.0, c_z = 0.0;

  /// The curve of the leg continued to a range, straight but for the water's gradient.
  [[nodiscard]] ColumnCrossing continued_to(double target, double sign) const noexcept;
};

/// A piece of a ray from one boundary to the next, or to where it turns back; its range grows or
/// falls all along. Rays of one history hit the same boundaries (and
/// facets of them, where the tangent jumps) in the same order up to the leg.
struct RayLeg {
  std::uint64_t history = 0;
  LegEnd begin, end;
  double d_begin = 0.0, d_end = 0.0;  ///< how the ranges of its ends move along the boundaries when
                                      ///< the ray is launched a little higher, dr/dα [m/rad]
  double sign = -1.0;  ///< of the ray's normal: (−1)^(bounces + 1), so that ∂z/∂α = sign·q/(c·ξ)
  double strength = 1.0;       ///< product of the reflections' magnitudes before it
  bool from_boundary = false;  ///< begins there, rather than at the source
  BoundaryKind begins_at = BoundaryKind::surface;  ///< which boundary
  bool to_boundary = false;  ///< ends there, rather than at the limits of the trace
  BoundaryKind ends_at = BoundaryKind::surface;
  int turns_begin = 0, turns_end = 0;  ///< turning points passed before and within
  std::uint64_t turned_in = 0;         ///< tells the rows of the water they lie in
  std::uint32_t first_column = 0;  ///< crossings of columns first … last − 1, by increasing range
  std::uint32_t last_column = 0;
  std::uint32_t first_crossing = 0;  ///< of them in FanRay::crossings

  [[nodiscard]] bool covers(std::uint32_t column) const noexcept {
    return column >= first_column && column < last_column;
  }
  [[nodiscard]] double extent() const noexcept;  ///< horizontal [m]
  [[nodiscard]] int turns_at(bool its_end) const noexcept {
    return its_end ? turns_end : turns_begin;
  }
};

/// One ray of a fan, boiled down to what neighbours are compared by.
struct FanRay {
  double angle = 0.0;           ///< launch elevation [rad]
  std::vector<LegOfRay> parts;  ///< of the trajectory, one for each leg
  std::vector<RayLeg> legs;
  std::vector<ColumnCrossing> crossings;
  RayEnd ended = RayEnd::box;

  [[nodiscard]] const ColumnCrossing& crossing(const RayLeg& leg,
                                               std::uint32_t column) const noexcept {
    return crossings[leg.first_crossing + (column - leg.first_column)];
  }
  /// Where a leg crosses a column, or would if the boundaries at its ends were a little further
  /// away (no more than a part of its extent).
  [[nodiscard]] std::optional<ColumnCrossing> crossing_or_continued(const RayLeg& leg,
                                                                    std::uint32_t column,
                                                                    double range) const noexcept;
};

/// dr/dα of the place where a ray strikes a boundary: the beam's displacement q·dα across the ray,
/// seen along the boundary. \param end  of the leg \param sign  RayLeg::sign
[[nodiscard]] double range_per_angle(const LegEnd& end, const Boundary& boundary,
                                     double sign) noexcept;

/// Of the boundary as a place; for a curvilinear shape not the slope that reflects.
[[nodiscard]] double position_slope(const Boundary& boundary, double range) noexcept;

/// \param out  its memory is reused
void digest(const RayTrajectory& ray, const Environment& environment,
            std::span<const ReceiverColumn> columns, FanRay& out);

/// A ray at a column, for one leg of it: the exact state, or the state at the leg's end when the
/// receiver lies on the boundary that ends it.
struct ExactCrossing {
  RayState state;
  RayHistory history;
  double c = 0.0;
  std::uint32_t row = 0;  ///< of the water
  bool real = false;      ///< the leg passes the column, or ends within a millimetre of it
  ColumnCrossing crossing;
};

/// \param tracer  of the ray
[[nodiscard]] ExactCrossing cross_leg(const RayTrajectory& ray, const RayTracer& tracer,
                                      const LegOfRay& leg, double range);

/// \param tracer  of the ray   \param leg  index of the leg   \param history  which it must have;
/// none if the ray has another
[[nodiscard]] std::optional<ExactCrossing> cross_column(const RayTrajectory& ray,
                                                        const RayTracer& tracer, std::size_t leg,
                                                        std::uint64_t history, double range);

}  // namespace asdic::detail
