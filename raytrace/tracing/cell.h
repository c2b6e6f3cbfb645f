#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "raytrace/ocean/environment.h"
#include "raytrace/tracing/ray_trajectory.h"

namespace asdic::detail::tracing {

/// How a ray runs in a cell.
enum class Law : unsigned char {
  arc,       ///< c linear in depth: an arc of a circle
  parabola,  ///< 1/c² linear in depth: a parabola
  cubic,     ///< c a cubic in depth: a power series
  bilinear,  ///< c bilinear in range and depth: likewise
  munk,      ///< Munk's law: likewise
};

/// A slab of water between two depths at which something changes: samples of the profile, of the
/// attenuation, flat boundaries, the depths that shaped boundaries reach.
struct Row {
  double top = 0.0, bottom = 0.0;  ///< [m], ±1e30 for the outer ones
  std::size_t interval = 0;        ///< of the profile, or depth row of the section
  double alpha_top = 0.0;          ///< attenuation at depth 0 by the row's line [Np/m]
  double alpha_slope = 0.0;        ///< [Np/m²]
  bool near_surface = false;       ///< whether a shaped boundary reaches into it
  bool near_bottom = false;
  [[nodiscard]] double alpha(double depth) const noexcept {
    return alpha_top + alpha_slope * depth;
  }
};

/// The law of the water in one cell: a row, and with a section a column. With t = z − z0 and
/// u = r − r0,
///
///   a[0] + a[1]t + a[2]t² + a[3]t³ + u·(b[0] + b[1]t)
///
/// is c, or 1/c² for a parabola; Munk's law has its own parameters.
struct Cell {
  const Row* row = nullptr;
  Law law = Law::arc;
  double r0 = 0.0, z0 = 0.0;
  std::array<double, 4> a{};
  std::array<double, 2> b{};
  const MunkParameters* munk = nullptr;

  /// Speed by the cell's law, whether the point lies inside or not.
  [[nodiscard, gnu::always_inline]] SoundSpeed2D speed(double range, double depth) const noexcept {
    const double t = depth - z0;
    switch (law) {
      case Law::arc:
        return {.c = a[0] + a[1] * t, .c_z = a[1]};
      case Law::parabola: {
        const double c = 1.0 / std::sqrt(a[0] + a[1] * t);
        const double c_z = -0.5 * c * c * c * a[1];  // c′ = −c³/2·d(1/c²)/dz
        return {.c = c, .c_z = c_z, .c_zz = 3.0 * c_z * c_z / c};
      }
      case Law::cubic:
        return {.c = a[0] + t * (a[1] + t * (a[2] + t * a[3])),
                .c_z = a[1] + t * (2.0 * a[2] + t * 3.0 * a[3]),
                .c_zz = 2.0 * a[2] + 6.0 * a[3] * t};
      case Law::bilinear: {
        const double u = range - r0, c_r = b[0] + b[1] * t;
        return {.c = a[0] + a[1] * t + u * c_r, .c_r = c_r, .c_z = a[1] + u * b[1], .c_rz = b[1]};
      }
      case Law::munk:
        break;
    }
    return munk_speed(depth);
  }

 private:
  [[nodiscard]] SoundSpeed2D munk_speed(double depth) const noexcept;
};

/// What a cell's law says where a ray is.
struct Local {
  double c, c_r, c_z, c_nn;
};
[[nodiscard, gnu::always_inline]] inline Local local(const Cell& cell, const RayState& y) noexcept {
  const SoundSpeed2D s = cell.speed(y.range, y.depth);
  const double tr = s.c * y.xi, tz = s.c * y.zeta;
  // ∂²c/∂n² with n = (−t_z, t_r)
  return {s.c, s.c_r, s.c_z, s.c_rr * tz * tz - 2.0 * s.c_rz * tr * tz + s.c_zz * tr * tr};
}

inline constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace asdic::detail::tracing
