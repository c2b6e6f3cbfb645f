#pragma once
#include "raytrace/tracing/cell.h"

namespace asdic::detail::tracing {

/// What a ray gathers between two depths of a row where the speed depends on depth alone.
struct RowCrossing {
  double speed_integral = 0.0;            ///< ∫c ds [m²/s]
  double range = 0.0;                     ///< ξ·∫c ds [m], signed
  double time = 0.0;                      ///< [s]
  double length = 0.0;                    ///< [m]
  double depth_integral = 0.0;            ///< ∫(z − z₀) ds [m²]; lossy rows (α varies) only
  double spread = 0.0;                    ///< ∂|range|/∂|ξ| between the two depths [m²/s]
  double sine = 0.0;                      ///< |t_z| at the end
  double c = 0.0, c_z = 0.0, c_zz = 0.0;  ///< the water there
  double turn = 0.0;                      ///< bound of what the direction turns by on the way [rad]
};

/// Snell's invariant ξ carries a ray from depth to depth without a step: on arcs and parabolas in
/// closed form, elsewhere by Gauss–Legendre quadrature over depth, with as many nodes as the
/// distance of the nearest (complex) turning depth asks for; docs/theory/rays.md.
/// \param here  of the cell, at y   \param to  a depth of the cell's row that the ray heads for
/// \return false: no such law, or too shallow or too bent for it; take a step instead
[[nodiscard]] bool cross_row(const Cell& cell, const RayState& y, const Local& here, double to,
                             RowCrossing& out) noexcept;

/// q and p of one solution at the end of a crossing. At a fixed depth the neighbouring ray is
/// −q/t_z further on and its ξ greater by −p·t_z − c_z·ξ²·q, which it keeps.
inline void carry_tube(double q, double p, double xi, double tz, double c_z, const RowCrossing& x,
                       double tz_end, double& q_end, double& p_end) noexcept {
  const double d_xi = -p * tz - c_z * xi * xi * q;
  q_end = tz_end * (q / tz - x.spread * d_xi);
  p_end = -(d_xi + x.c_z * xi * xi * q_end) / tz_end;
}

}  // namespace asdic::detail::tracing
