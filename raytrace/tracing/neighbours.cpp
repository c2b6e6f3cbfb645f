#include "raytrace/tracing/neighbours.h"

#include <algorithm>
#include <cmath>

#include "raytrace/layered/hermite.h"

namespace asdic {
namespace {

/// What the cubic may miss the ray in the middle by [m]; the two cubics through it are then right
/// to a sixteenth of that.
constexpr double tolerance = 0.5;

/// Launch angles closer than this are told apart no more [rad].
constexpr double finest = 4e-15;

/// Where histories part at a node between two facets, rays reach up to it: what lies between two
/// rays that are closer than this everywhere is left out [m].
constexpr double finest_gap = 1e-4;

/// How far from the place where a leg turns around a column may be to be looked at [m].
constexpr double least_room = 0.1;

bool stopped_by_limits(const FanRay& ray) noexcept {
  return ray.ended == RayEnd::bounces || ray.ended == RayEnd::faint ||
         ray.ended == RayEnd::absorbed;
}

/// Rays whose tube has been spread so thin, or reflected so often, that they are 80 dB below
/// spherical spreading are not followed into finer branches: over rough boundaries there is no end
/// of them.
bool too_faint(const RayLeg& leg, double widest) noexcept {
  const double range = std::max(std::abs(leg.begin.range), 1.0);
  return leg.strength * leg.strength * range < 1e-8 * widest;  // A²r² = R² r cos θ₀/|q|
}

bool finest_apart(double a, double b) noexcept {
  return std::abs(b - a) < finest + 4e-16 * std::abs(a);
}

}  // namespace

ColumnSpan columns_between(const FanRay& a, const FanRay& b, std::size_t leg,
                           std::span<const ReceiverColumn> columns) noexcept {
  const RayLeg &la = a.legs[leg], &lb = b.legs[leg];
  ColumnSpan span{std::min(la.first_column, lb.first_column),
                  std::max(la.last_column, lb.last_column)};
  if (la.first_column >= la.last_column) span = {lb.first_column, lb.last_column};
  if (lb.first_column >= lb.last_column) span = {la.first_column, la.last_column};
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

double splitting_angle(const FanRay& a, const FanRay& b, const Environment& environment) noexcept {
  const double middle = 0.5 * (a.angle + b.angle);
  const std::size_t legs = std::min(a.legs.size(), b.legs.size());
  std::size_t i = 0;
  while (i < legs && a.legs[i].history == b.legs[i].history) ++i;
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

bool NeighbourTest::holds(const FanRay& a, const FanRay& m, const FanRay& b) const {
  const std::size_t legs = std::max({a.legs.size(), m.legs.size(), b.legs.size()});
  for (std::size_t i = 0; i < legs; ++i) {
    const bool together = i < a.legs.size() && i < m.legs.size() && i < b.legs.size() &&
                          a.legs[i].history == b.legs[i].history &&
                          a.legs[i].history == m.legs[i].history;
    if (!together) return !parting_matters(a, m, b, i);
    if (!leg_holds(a, m, b, i)) return false;
  }
  return true;
}

bool NeighbourTest::leg_holds(const FanRay& a, const FanRay& m, const FanRay& b,
                              std::size_t i) const {
  const RayLeg &la = a.legs[i], &lm = m.legs[i], &lb = b.legs[i];
  if (too_faint(la, std::min(std::abs(la.begin.q), std::abs(la.end.q))) &&
      too_faint(lb, std::min(std::abs(lb.begin.q), std::abs(lb.end.q))))
    return true;
  if (!ends_hold(a, m, b, i)) return false;
  const double width = b.angle - a.angle;
  const auto [first, last] = columns_between(a, b, i, columns_);
  for (std::uint32_t k = first; k < last; ++k) {
    const ReceiverColumn& column = columns_[k];
    const auto za = a.crossing_or_continued(la, k, column.range);
    const auto zb = b.crossing_or_continued(lb, k, column.range);
    if (!za || !zb) {  // too far beyond the end of its leg: are there receivers up to there?
      const double known = za ? za->depth : zb ? zb->depth : la.end.depth;
      const double far = za ? lb.end.depth : la.end.depth;
      const double near = za ? lb.begin.depth : la.begin.depth;
      const double low = std::min({known, far, near}), high = std::max({known, far, near});
      if (!column.between(low, high).empty() && !finest_apart(a.angle, b.angle)) return false;
      continue;
    }
    const auto zm = m.crossing_or_continued(lm, k, column.range);
    if (!zm) continue;
    const Hermite cubic({a.angle, za->depth, za->slope}, {b.angle, zb->depth, zb->slope});
    // the slope tells what a lucky value does not
    const double error = std::max(std::abs(cubic.value(m.angle) - zm->depth),
                                  std::abs(cubic.slope(m.angle) - zm->slope) * 0.125 * width);
    const bool turns_apart = std::abs(za->turns - zb->turns) > 1;
    if (error * zm->cosine < tolerance && !turns_apart) continue;
    const double low = std::min({za->depth, zb->depth, zm->depth});
    const double high = std::max({za->depth, zb->depth, zm->depth});
    const double margin = 0.5 * (high - low) + 4.0 * error + tolerance;
    if (!column.between(low - margin, high + margin).empty() && !finest_apart(a.angle, b.angle))
      return false;
  }
  return true;
}

/// Whether the place where the leg strikes a boundary is known, for receivers near it.
bool NeighbourTest::ends_hold(const FanRay& a, const FanRay& m, const FanRay& b,
                              std::size_t i) const {
  const RayLeg &la = a.legs[i], &lm = m.legs[i], &lb = b.legs[i];
  if (!la.to_boundary || !lm.to_boundary || !lb.to_boundary) return true;
  const Hermite place({a.angle, la.end.range, la.d_end}, {b.angle, lb.end.range, lb.d_end});
  const double error =
      std::max(std::abs(place.value(m.angle) - lm.end.range),
               std::abs(place.slope(m.angle) - lm.d_end) * 0.125 * (b.angle - a.angle));
  const double steep = std::abs(lm.end.zeta * lm.end.c);
  if (error * steep < tolerance) return true;
  // Receivers that the legs' ends may sweep over lie close to the boundary there.
  const double low = std::min({la.end.range, lm.end.range, lb.end.range}) - error;
  const double high = std::max({la.end.range, lm.end.range, lb.end.range}) + error;
  const double sweep = tolerance + error * steep;
  const double shallow = std::min({la.end.depth, lm.end.depth, lb.end.depth}) - sweep;
  const double deep = std::max({la.end.depth, lm.end.depth, lb.end.depth}) + sweep;
  for (auto column = std::partition_point(columns_.begin(), columns_.end(),
                                          [&](const auto& c) { return c.range < low; });
       column != columns_.end() && column->range <= high; ++column)
    if (!column->between(shallow, deep).empty() && !finest_apart(a.angle, b.angle)) return false;
  return true;
}

/// Three rays no longer share their history from leg i on. Splitting goes on until the rays left
/// out are too few to matter, unless no receiver lies further on.
bool NeighbourTest::parting_matters(const FanRay& a, const FanRay& m, const FanRay& b,
                                    std::size_t i) const {
  if (finest_apart(a.angle, b.angle)) return false;
  double nearest = 1e300, farthest = -1e300, widest = 0.0;
  bool same_boundary = true, turned_back = false, all_faint = true;
  for (const FanRay* ray : {&a, &m, &b}) {
    if (i >= ray->legs.size()) {
      if (stopped_by_limits(*ray)) return false;  // no more of the two than this one has
      same_boundary = false;
      continue;
    }
    for (std::size_t k = i; k < ray->legs.size(); ++k) {
      const RayLeg& leg = ray->legs[k];
      nearest = std::min({nearest, leg.begin.range, leg.end.range});
      farthest = std::max({farthest, leg.begin.range, leg.end.range});
      widest = std::max({widest, std::abs(leg.begin.q), std::abs(leg.end.q)});
      turned_back |= leg.end.range < leg.begin.range;
      all_faint &= too_faint(leg, std::min(std::abs(leg.begin.q), std::abs(leg.end.q)));
    }
  }
  const auto beyond =
      std::partition_point(columns_.begin(), columns_.end(),
                           [&](const ReceiverColumn& column) { return column.range < nearest; });
  // Rays between may reach further than the three, though not far beyond them.
  if (beyond == columns_.end() || beyond->range > 2.0 * farthest - nearest) return false;
  if (!same_boundary) return true;
  const RayLeg &la = a.legs[i], &lb = b.legs[i];
  const bool at_a_node = la.from_boundary && lb.from_boundary &&
                         std::abs(la.begin.range - lb.begin.range) < finest_gap &&
                         std::abs(la.begin.depth - lb.begin.depth) < finest_gap;
  return !(at_a_node && widest * std::abs(b.angle - a.angle) < finest_gap);
}

}  // namespace asdic
