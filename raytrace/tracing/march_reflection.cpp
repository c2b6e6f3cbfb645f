// What a boundary does to a marching ray.
#include "raytrace/tracing/march.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail::tracing {
namespace {

/// As std::arg, which takes a real number the long way.
double phase_of(const std::complex<double>& coefficient) noexcept {
  if (coefficient.imag() != 0.0) return std::arg(coefficient);
  return std::signbit(coefficient.real()) ? std::copysign(pi, coefficient.imag()) : 0.0;
}

}  // namespace

Tangent March::tangent_at(BoundaryKind kind) const noexcept {
  const Boundary& wall = boundary(kind);
  if (!wall.shape) return {};
  const std::size_t facet = kind == BoundaryKind::surface ? surface_facet_ : bottom_facet_;
  const BoundaryPoint point = wall.shape->at(y_.range, facet);
  const double length = std::sqrt(1.0 + point.slope * point.slope);
  return {.r = 1.0 / length, .z = point.slope / length, .curvature = point.curvature};
}

bool March::reflect_at(BoundaryKind kind) {
  const bool surface = kind == BoundaryKind::surface;
  const Boundary& wall = boundary(kind);
  int& bounces = surface ? history_.surface_bounces : history_.bottom_bounces;
  if (bounces >= (surface ? limits_.max_surface_bounces : limits_.max_bottom_bounces))
    return end(RayEnd::bounces);
  const Local water = local(*cell_, y_);
  Tangent tangent = tangent_at(kind);
  const RayState in = y_;
  RayState out = y_;
  double grazing = reflect(out, water, tangent);
  if (wall.shape && wall.shape->interpolation() == ShapeInterpolation::curvilinear) {
    // the turned tangent may send a grazing ray through the facet: then the facet itself reflects
    const std::size_t facet = surface ? surface_facet_ : bottom_facet_;
    const double slope =
        wall.shape->depth_at(y_.range + 0.5, facet) - wall.shape->depth_at(y_.range - 0.5, facet);
    const double away = (out.zeta - slope * out.xi) * (surface ? 1.0 : -1.0);
    if (away <= 0.0) {
      tangent = {.r = 1.0 / std::hypot(1.0, slope), .z = slope / std::hypot(1.0, slope)};
      out = y_;
      grazing = reflect(out, water, tangent);
    }
  }
  y_ = out;
  ++bounces;
  const BoundaryMaterial* material = &wall.material;
  if (wall.shape && !wall.shape->materials().empty()) {
    const std::size_t facet = surface ? surface_facet_ : bottom_facet_;
    material = &wall.shape->materials()[facet == 0 ? 0 : facet - 1];
  }
  const WaterAtBoundary beside{.speed = water.c,
                               .density = ocean_.environment.water_density.at(y_.depth),
                               .frequency = ocean_.frequency};
  std::complex<double> coefficient = reflection_coefficient(*material, grazing, beside);
  const Roughness& rough =
      (surface ? ocean_.environment.surface : ocean_.environment.bottom).roughness;
  const double phase = phase_of(coefficient);
  double scattered = 0.0;
  if (!rough.smooth() || history_.scattered > 0.0) {
    const RoughReflection left =
        rough_reflection(rough, std::sin(grazing), 2.0 * pi * ocean_.frequency / water.c);
    const double mean = left.coherent * left.coherent;
    scattered = std::norm(coefficient) *
                (history_.scattered * left.energy +
                 std::norm(history_.reflection) * std::max(0.0, left.energy - mean));
    coefficient *= left.coherent;
  }
  out_.bounces.push_back({.boundary = kind, .grazing = grazing, .range = y_.range - source_range_});
  history_.reflection *= coefficient;
  history_.reflection_phase += phase;
  history_.scattered = scattered;
  const double left = std::sqrt(std::norm(history_.reflection) + scattered);
  if (left == 0.0) return end(RayEnd::absorbed);
  if (left < limits_.faintest) return end(RayEnd::faint);
  if (ocean_.reflection == Reflection::on_the_spot) return true;
  return displace_along(kind, in, water, tangent,
                        beam_displacement(*material, grazing, beside, ocean_.frequency));
}

}  // namespace asdic::detail::tracing
