#include "raytrace/tracing/neighbours.h"

#include <algorithm>
#include <cmath>

#include "raytrace/math/hermite.h"

namespace asdic::detail {

ColumnSpan columns_between(const FanRay& a, const FanRay& b, std::size_t leg,
                           std::span<const ReceiverColumn> columns) noexcept {
  const RayLeg &la = a.legs[leg], &lb = b.legs[leg];
  ColumnSpan span{std::min(la.first_column, lb.first_column),
                  std::max(la.last_column, lb.last_column)};
  const auto reach = [&](double ra, double da, double rb, double db) {
    if ((da > 0.0) == (db > 0.0)) return;
    const Hermite place({a.angle, ra, da}, {b.angle, rb, db});
    for (std::size_t i = 0; i < place.extrema().size(); ++i) {
      const double range = place.value(place.extrema().x[i]);
      const double low = std::min({ra, rb, range}) - least_room;
      const double high = std::max({ra, rb, range}) + least_room;
      while (span.first > 0 && columns[span.first - 1].range >= low) --span.first;
      while (span.last < columns.size() && columns[span.last].range <= high) ++span.last;
    }
  };
  if (la.to_boundary && lb.to_boundary) reach(la.end.range, la.d_end, lb.end.range, lb.d_end);
  if (la.from_boundary && lb.from_boundary)
    reach(la.begin.range, la.d_begin, lb.begin.range, lb.d_begin);
  return span;
}

namespace {

/// Of two neighbours one grazes a flat boundary that the other turns short of, or passes. The
/// square of the sine at which it is struck is smooth in the launch angle, and zero for the ray
/// between: Newton's method, a little too far and a little too short in turns, so that that ray is
/// enclosed. At the boundary's depth the direction changes by
///   d(t_z²)/dα = 2[c·p·t_r·t_z + (c_n − c_n·t_z²)·q/c],  c_n = c_z·t_r − c_r·t_z.
/// \param from  where the grazing ray strikes \param width  of the interval
/// \return the way from its angle, infinity if that is not between the two
double way_to_grazing(const LegEnd& from, double width) noexcept {
  const double tr = from.c * from.xi, tz = from.c * from.zeta;
  const double c_n = from.c_z * tr - from.c_r * tz;
  const double rate = 2.0 * (from.c * from.p * tr * tz + c_n * (1.0 - tz * tz) * from.q / from.c);
  const double way = std::abs(tz * tz / rate);
  const double wanted = (1.02 * way < 0.9 * width ? 1.02 : 0.98) * way;
  return wanted < width ? wanted : 1e300;
}

}  // namespace

double splitting_angle(const FanRay& a, const FanRay& b, const Environment& environment) noexcept {
  const double middle = 0.5 * (a.angle + b.angle);
  const std::size_t legs = std::min(a.legs.size(), b.legs.size());
  std::size_t i = 0;
  while (i < legs && a.legs[i].history == b.legs[i].history) ++i;
  if (i > 0) {
    const RayLeg &ja = a.legs[i - 1], &jb = b.legs[i - 1];
    const double width = b.angle - a.angle;
    const auto way = [&](const RayLeg& leg, const RayLeg& other) {
      const bool flat =
          !(leg.ends_at == BoundaryKind::surface ? environment.surface : environment.bottom).shape;
      const bool alone = leg.to_boundary && !(other.to_boundary && other.ends_at == leg.ends_at);
      const bool grazing = std::abs(leg.end.zeta * leg.end.c) < 0.1;
      return flat && alone && grazing ? way_to_grazing(leg.end, width) : 1e300;
    };
    if (const double from_a = way(ja, jb); from_a < width) return a.angle + from_a;
    if (const double from_b = way(jb, ja); from_b < width) return b.angle - from_b;
  }
  if (i == legs) return middle;
  const RayLeg &la = a.legs[i], &lb = b.legs[i];
  if (!la.from_boundary || !lb.from_boundary || la.begins_at != lb.begins_at) return middle;
  const Boundary& wall =
      la.begins_at == BoundaryKind::surface ? environment.surface : environment.bottom;
  if (!wall.shape) return middle;
  const std::size_t fa = wall.shape->facet(la.begin.range), fb = wall.shape->facet(lb.begin.range);
  if (fa == fb) return middle;
  const double node = wall.shape->facet_begin((fa + fb + 1) / 2);
  constexpr double too_far = 1.02;
  const double from_a = too_far * (node - la.begin.range) / la.d_begin;
  const double from_b = too_far * (node - lb.begin.range) / lb.d_begin;
  const double width = b.angle - a.angle;
  const bool good_a = from_a > 0.0 && from_a < width, good_b = from_b < 0.0 && from_b > -width;
  if (good_a && (!good_b || from_a < -from_b)) return a.angle + from_a;
  return good_b ? b.angle + from_b : middle;
}

}  // namespace asdic::detail
