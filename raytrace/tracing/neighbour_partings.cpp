// Where neighbours of a fan no longer share their history: whether it matters to any receiver.
#include <algorithm>
#include <cmath>

#include "raytrace/tracing/neighbours.h"

namespace asdic::detail {
namespace {

/// Where histories part at a node between two facets, rays reach up to it: what lies between two
/// rays that are closer than this everywhere is left out [m].
constexpr double finest_gap = 1e-4;

/// How far apart rays that part may stay where there is neither a receiver nor a node near [m].
constexpr double narrow_gap = 0.3;

bool stopped_by_limits(const FanRay& ray) noexcept {
  return ray.ended == RayEnd::bounces || ray.ended == RayEnd::faint ||
         ray.ended == RayEnd::absorbed;
}

/// Whether the place where a leg begins runs about evenly from one ray to another.
bool steady(const FanRay& a, const RayLeg& la, const FanRay& b, const RayLeg& lb) noexcept {
  const double mean = (lb.begin.range - la.begin.range) / (b.angle - a.angle);
  return la.d_begin / mean > 0.5 && la.d_begin / mean < 2.0 && lb.d_begin / mean > 0.5 &&
         lb.d_begin / mean < 2.0;
}

/// From a leg on.
bool never_turns_back(const FanRay& ray, std::size_t leg) noexcept {
  return std::all_of(ray.legs.begin() + static_cast<std::ptrdiff_t>(leg), ray.legs.end(),
                     [](const RayLeg& l) { return l.end.range >= l.begin.range; });
}

}  // namespace

/// Rays that lack leg i because the trace ended, far behind the receivers, begin it there: whether
/// the legs of the others, and of all that lie between, pass no receiver before.
bool NeighbourTest::begins_behind_the_box(const FanRay& a, const FanRay& m, const FanRay& b,
                                          std::size_t i) const {
  const FanRay* has = nullptr;
  int with = 0;
  for (const FanRay* ray : {&a, &m, &b}) {
    if (i >= ray->legs.size()) {
      if (ray->ended != RayEnd::box || ray->legs.back().end.range < columns_.back().range)
        return false;
      continue;
    }
    const RayLeg& leg = ray->legs[i];
    if (has != nullptr &&
        (has->legs[i].history != leg.history || !steady(*has, has->legs[i], *ray, leg)))
      return false;
    has = ray;
    ++with;
    if (leg.end.range < leg.begin.range || ray->legs.size() > i + 1) return false;
    const double towards = i >= b.legs.size() ? 1.0 : -1.0;
    if (!(leg.d_begin * towards > 0.0)) return false;
    // onwards to where the rays that lack it begin it
    const double from = leg.begin.depth;
    const auto wall =
        leg.begins_at == BoundaryKind::surface ? &environment_.surface : &environment_.bottom;
    for (std::uint32_t c = leg.first_column; c < columns_.size(); ++c) {
      const ReceiverColumn& column = columns_[c];
      const double at_wall = wall->depth_at(column.range);
      double low = std::min(from, at_wall), high = std::max(from, at_wall);
      if (leg.covers(c)) {
        low = std::min(low, ray->crossing(leg, c).depth);
        high = std::max(high, ray->crossing(leg, c).depth);
      }
      const double room = 0.5 * (high - low) + least_room;
      if (!column.between(low - room, high + room).empty()) return false;
    }
  }
  return with == 2;
}

/// Whether nothing but what lies between rays close together is lost when the gap in which they
/// part at leg i is left: they stay within `narrow_gap` of each other, away from nodes and from the
/// receivers.
bool NeighbourTest::gap_is_clear(std::initializer_list<const FanRay*> rays, double width,
                                 std::size_t i) const {
  const double last = columns_.back().range;
  for (const FanRay* ray : rays)
    for (std::size_t k = i; k < ray->legs.size(); ++k) {
      const RayLeg& leg = ray->legs[k];
      if (leg.begin.range > last && never_turns_back(*ray, k)) break;
      if (std::max(std::abs(leg.begin.q), std::abs(leg.end.q)) * width > narrow_gap) return false;
      for (std::uint32_t c = leg.first_column; c < leg.last_column; ++c) {
        const ColumnCrossing& there = ray->crossing(leg, c);
        const double way = way_to(*ray, columns_[c].range);
        const double room = least_room + 4.0 * std::max(std::abs(there.slope), way) * width;
        if (!columns_[c].between(there.depth - room, there.depth + room).empty()) return false;
      }
      for (const bool ends : {false, true}) {
        const LegEnd& at = ends ? leg.end : leg.begin;
        if (!(ends ? leg.to_boundary : leg.from_boundary)) continue;
        const double room = least_room + 4.0 * std::abs(ends ? leg.d_end : leg.d_begin) * width;
        const auto near = std::partition_point(
            columns_.begin(), columns_.end(),
            [&](const ReceiverColumn& c) { return c.range < at.range - room; });
        if (near != columns_.end() && near->range <= at.range + room) return false;
        if (ends && !one_facet(at.range - room, at.range + room)) return false;
      }
    }
  return true;
}

/// Whether no node of a boundary lies between two ranges.
bool NeighbourTest::one_facet(double from, double to) const noexcept {
  for (const Boundary* wall : {&environment_.surface, &environment_.bottom})
    if (wall->shape && wall->shape->interpolation() == ShapeInterpolation::piecewise_linear &&
        wall->shape->facet(from) != wall->shape->facet(to))
      return false;
  return true;
}

/// Three rays no longer share their history from leg i on. Splitting goes on until the rays left
/// out are too few to matter, unless no receiver lies further on.
bool NeighbourTest::parting_matters(const FanRay& a, const FanRay& m, const FanRay& b,
                                    std::size_t i) const {
  if (finest_apart(a.angle, b.angle) || begins_behind_the_box(a, m, b, i)) return false;
  double nearest = 1e300, farthest = -1e300, widest = 0.0;
  bool same_boundary = true, turned_back = false;
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
    }
  }
  // Rays between may reach further than the three, though not far beyond them.
  const double room = farthest - nearest, low = turned_back ? nearest - room : nearest;
  const auto reached = std::partition_point(columns_.begin(), columns_.end(),
                                            [&](const auto& column) { return column.range < low; });
  if (reached == columns_.end() || reached->range > farthest + room) return false;
  if (gap_is_clear({&a, &m, &b}, b.angle - a.angle, i)) return false;
  if (!same_boundary) return true;
  const RayLeg &la = a.legs[i], &lb = b.legs[i];
  const bool at_a_node = la.from_boundary && lb.from_boundary &&
                         std::abs(la.begin.range - lb.begin.range) < finest_gap &&
                         std::abs(la.begin.depth - lb.begin.depth) < finest_gap;
  return !(at_a_node && widest * std::abs(b.angle - a.angle) < finest_gap);
}

}  // namespace asdic::detail
