#pragma once
#include <cstddef>
#include <limits>
#include <vector>

#include "raytrace/environment.h"
#include "raytrace/tracing/ray_trajectory.h"

namespace asdic::tracing {

/// How a ray runs in a cell.
enum class Law : unsigned char {
  arc,       ///< c linear in depth: an arc of a circle
  parabola,  ///< 1/c² linear in depth: a parabola
  general,   ///< anything smooth: integrated
};

/// A slab of water between two depths at which something changes: samples of the profile, of the
/// attenuation, flat boundaries, the depths that shaped boundaries reach.
struct Row {
  double top = 0.0, bottom = 0.0;  ///< [m], ±1e30 for the outer ones
  std::size_t interval = 0;        ///< of the profile, or depth row of the section
  double alpha_top = 0.0;          ///< attenuation at depth 0 by the row's line [Np/m]
  double alpha_slope = 0.0;        ///< [Np/m²]
  [[nodiscard]] double alpha(double depth) const noexcept {
    return alpha_top + alpha_slope * depth;
  }
};

/// The law of the water in one cell: a row, and with a section a column.
struct Cell {
  const Environment* ocean = nullptr;
  const Row* row = nullptr;
  std::size_t column = 0;
  Law law = Law::general;

  /// Speed by the cell's law, whether the point lies inside or not.
  [[nodiscard]] SoundSpeed2D speed(double range, double depth) const noexcept;
};

/// What a cell's law says where a ray is.
struct Local {
  double c, c_r, c_z, c_nn;
};
[[nodiscard]] Local local(const Cell& cell, const RayState& y) noexcept;

/// The ray a step further: `h` is arc length, but for a parabola ∫c ds. Exact for arcs and
/// parabolas; for the general law one step of Dormand and Prince (1980), order 5. \param error  if
/// not null and the law is general: the step's error over its tolerance
[[nodiscard]] RayState advance(const Cell& cell, const RayState& y, double h,
                               double* error = nullptr) noexcept;

/// d(arc length)/dh at y.
[[nodiscard]] inline double arc_rate(const Cell& cell, double c) noexcept {
  return cell.law == Law::parabola ? 1.0 / c : 1.0;
}

/// The step to a depth in the direction of travel, exact for arcs and parabolas, a prediction by
/// the ray's present curvature for the general law; infinity if the ray turns before.
[[nodiscard]] double step_to_depth(const Cell& cell, const RayState& y, double depth) noexcept;

/// The step to the next turning point (ζ = 0), likewise; infinity if it bends the other way.
[[nodiscard]] double step_to_turn(const Cell& cell, const RayState& y) noexcept;

inline constexpr double never = std::numeric_limits<double>::infinity();

/// Error of one general step that is accepted [m]; that of τ is a thousandth of it in seconds.
inline constexpr double position_tolerance = 1e-7;

}  // namespace asdic::tracing
