#include "raytrace/tracing/jumps.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail::tracing {
namespace {

/// A ray along the line itself would have no tube; this keeps its numbers finite.
double away_from_zero(double sine) noexcept {
  constexpr double least = 1e-12;
  return std::abs(sine) < least ? std::copysign(least, sine) : sine;
}

}  // namespace

double reflect(RayState& y, const Local& water, const Tangent& boundary) noexcept {
  const double c = water.c;
  const double tr = c * y.xi, tz = c * y.zeta;
  const double cosine = boundary.r * tr + boundary.z * tz;                // cos(β − φ)
  const double sine = away_from_zero(boundary.z * tr - boundary.r * tz);  // sin(β − φ)
  // mirrored at the tangent: φ_out = 2β − φ_in
  const double out_r = cosine * boundary.r - sine * boundary.z;
  const double out_z = cosine * boundary.z + sine * boundary.r;
  // n = (−t_z, t_r)
  const double bends = -(water.c_r * -(tz + out_z) + water.c_z * (tr + out_r)) / c;
  const double jump = (bends * cosine - 2.0 * boundary.curvature) / (c * sine);
  y.p += y.q * jump;
  y.p_plane += y.q_plane * jump;
  y.xi = out_r / c;
  y.zeta = out_z / c;
  return std::asin(std::min(1.0, std::abs(sine)));
}

void cross(RayState& y, const Local& before, const Local& after, const Tangent& line) noexcept {
  const double dr = after.c_r - before.c_r, dz = after.c_z - before.c_z;
  if (dr == 0.0 && dz == 0.0) return;
  const double c = before.c;
  const double tr = c * y.xi, tz = c * y.zeta;
  const double cosine = line.r * tr + line.z * tz;
  const double sine = away_from_zero(line.z * tr - line.r * tz);
  const double jump = (-dr * tz + dz * tr) * cosine / (c * c * sine);
  y.p += y.q * jump;
  y.p_plane += y.q_plane * jump;
}

}  // namespace asdic::detail::tracing
