#include "raytrace/tracing/displace.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raytrace/tracing/march.h"

namespace asdic::detail::tracing {
namespace {

/// A ray at a line: γ = β − φ, and the bend of the ray, κ_ray = −∇c·n/c with n = (−t_z, t_r).
struct Meeting {
  Meeting(double c, double tr, double tz, const Local& water, const Tangent& line) noexcept
      : cosine(line.r * tr + line.z * tz),
        sine(line.z * tr - line.r * tz),
        bend(-(-water.c_r * tz + water.c_z * tr) / c) {
    constexpr double least = 1e-12;
    if (std::abs(sine) < least) sine = std::copysign(least, sine);
  }
  double cosine, sine, bend;
};

}  // namespace

double signed_displacement(const RayState& in, const Tangent& hit,
                           const BeamDisplacement& moved) noexcept {
  return std::copysign(1.0, hit.r * in.xi + hit.z * in.zeta) * moved.length;
}

int displace(const DisplacedReflection& r, RayState& y) noexcept {
  const double c = r.water.c, c_out = r.water_beyond.c;
  const double out_r = c * y.xi, out_z = c * y.zeta;
  const Meeting in(c, c * r.in.xi, c * r.in.zeta, r.water, r.hit);
  const Meeting out(c_out, out_r, out_z, r.water_beyond, r.leave);
  const double d = r.displacement;
  const double onward = std::copysign(1.0, in.cosine);
  const double c_along = r.water.c_r * r.hit.r + r.water.c_z * r.hit.z;
  int caustics = 0;
  const auto tube = [&](double q_in, double p_in, double& q, double& p) {
    const double dl = q_in / in.sine;  // per dα
    const double d_gamma = r.hit.curvature * dl - (c * p_in + in.bend * dl * in.cosine);
    // D = ±Δ(θ) by the sense of travel, and θ = asin|sin γ|
    const double d_d = std::copysign(1.0, in.sine) * r.rates.per_grazing * d_gamma +
                       onward * r.rates.per_speed * c_along * dl;
    // the neighbour leaves this far along: dr = u_r·(dl + dD) − D·u_z·κ·dl
    const double dr = r.hit.r * (dl + d_d) - d * r.hit.z * r.hit.curvature * dl;
    const double dl_out = dr / r.leave.r;
    // it was turned by 2κ·dl and mirrored; the normal flips
    const double turn = 2.0 * r.hit.curvature * dl - (c * p_in + in.bend * dl * in.cosine);
    q = -out.sine * dl_out;
    p = -(turn - out.bend * dl_out * out.cosine) / c_out;
    const double dk = -in.sine * d_gamma;  // ∝ dk_t
    return std::pair(dl_out * dl<0.0, dl_out * dk> 0.0);
  };
  const auto [passed, rising] = tube(r.in.q, r.in.p, y.q, y.p);
  if (passed) caustics = rising ? 1 : -1;
  (void)tube(r.in.q_plane, r.in.p_plane, y.q_plane, y.p_plane);
  y.time += d * in.cosine / c;
  y.speed_integral += std::abs(d) * c / std::max(std::abs(in.cosine), 1e-9);  // D/k_t
  y.xi = out_r / c_out;
  y.zeta = out_z / c_out;
  return caustics;
}

/// Carries the ray along the boundary; false when it has left the box.
bool March::displace_along(BoundaryKind kind, const RayState& in, const Local& water,
                           const Tangent& hit, const BeamDisplacement& moved) {
  const double d = signed_displacement(in, hit, moved);
  y_.range += d * hit.r;
  if (y_.range > limits_.max_range || y_.range < limits_.min_range) return end(RayEnd::box);
  const Boundary& wall = boundary(kind);
  if (ocean_.environment.section) {
    column_ = ocean_.column(y_.range);
    if (y_.xi < 0.0 && column_ > 0 && y_.range == ocean_.column_begin(column_)) --column_;
  }
  if (wall.shape) {
    std::size_t& facet = kind == BoundaryKind::surface ? surface_facet_ : bottom_facet_;
    facet = wall.shape->facet(y_.range);
    y_.depth = wall.shape->depth_at(y_.range, facet);
    enter(y_.depth);
  }
  const Local beyond = local(ocean_.cell(row_, column_), y_);
  history_.caustics += displace({.in = in,
                                 .water = water,
                                 .hit = hit,
                                 .water_beyond = beyond,
                                 .leave = tangent_at(kind),
                                 .displacement = d,
                                 .rates = moved},
                                y_);
  if (y_.q != 0.0) sense_ = std::copysign(1.0, y_.q);
  return true;
}

}  // namespace asdic::detail::tracing
