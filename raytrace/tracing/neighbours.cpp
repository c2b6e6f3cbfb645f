#include "raytrace/tracing/neighbours.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

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

// Whether two or three rays of a fan tell what lies between them.

namespace {

/// What the cubic may miss the ray in the middle by [m]; the two cubics through it are then right
/// to a sixteenth of that.
constexpr double tolerance = 0.5;

/// The same where the profile's knots leave cusps between them [m].
constexpr double cusp_tolerance = 0.05;

/// Far neighbours are of one kind when the cubic tells where the ray between strikes a boundary
/// to this [m], and to this part of the way between theirs.
constexpr double regular_miss = 1.0, regular_share = 0.05;

/// Two rays alone tell what lies between when all they say of it lies on lines to this [m].
constexpr double pair_miss = 0.1;

/// A cubic through two rays misses one between by E·16t²(1 − t)², t its place from 0 to 1, in value
/// and in slope by E/h·32t(1 − t)(1 − 2t): the part of E seen in the greater of the value's miss
/// and h/8 of the slope's where the third ray is; 1 in the middle. Beside a node or a ray that
/// grazes it is far from the middle, and a cubic that is right there is none that tells the rest.
double seen_at(const FanRay& a, const FanRay& m, const FanRay& b) noexcept {
  constexpr double least = 1e-3;  // quintics tell depths and slopes no better than that
  const double t = (m.angle - a.angle) / (b.angle - a.angle), bell = 4.0 * t * (1.0 - t);
  return std::max({bell * bell, bell * std::abs(1.0 - 2.0 * t), least});
}

/// Whether the cubic through two tells where the ray between them strikes the boundary.
bool strikes_evenly(const FanRay& a, const FanRay& m, const FanRay& b, std::size_t i) noexcept {
  const RayLeg &la = a.legs[i], &lm = m.legs[i], &lb = b.legs[i];
  if (!la.to_boundary || !lm.to_boundary || !lb.to_boundary) return true;
  const Hermite place({a.angle, la.end.range, la.d_end}, {b.angle, lb.end.range, lb.d_end});
  const double error =
      std::max(std::abs(place.value(m.angle) - lm.end.range),
               std::abs(place.slope(m.angle) - lm.d_end) * 0.125 * (b.angle - a.angle)) /
      seen_at(a, m, b);
  return error <= regular_miss + regular_share * std::abs(lb.end.range - la.end.range);
}

/// The least slope of the two cubics through three nodes, counted in the direction from the first
/// to the last.
double least_rise(const HermiteNode& a, const HermiteNode& m, const HermiteNode& b) noexcept {
  const double sense = b.value > a.value ? 1.0 : -1.0;
  double least = std::min({sense * a.slope, sense * m.slope, sense * b.slope});
  for (const auto& [from, to] : {std::pair(a, m), std::pair(m, b)}) {
    const Hermite cubic(from, to);
    const double bend_from = cubic.bend(from.x), bend_to = cubic.bend(to.x);
    if ((bend_from > 0.0) == (bend_to > 0.0)) continue;
    const double x = from.x + (to.x - from.x) * bend_from / (bend_from - bend_to);
    least = std::min(least, sense * cubic.slope(x));
  }
  return least;
}

/// The depths at which rays between two neighbours may pass a range when one of the two, or both,
/// are too far from it on this leg: up to where the leg ends, or begins, on a boundary.
struct DepthSpan {
  double low = 1e300, high = -1e300;
  void take(double depth) noexcept {
    low = std::min(low, depth);
    high = std::max(high, depth);
  }
};
DepthSpan swept_at(double range, const RayLeg& a, const RayLeg& b, bool one_of_two,
                   std::initializer_list<std::optional<ColumnCrossing>> known) {
  const auto beyond_end = [&](const RayLeg& leg) {
    return leg.end.range >= leg.begin.range ? range >= leg.end.range : range <= leg.end.range;
  };
  const auto before_begin = [&](const RayLeg& leg) {
    return leg.end.range >= leg.begin.range ? range < leg.begin.range : range > leg.begin.range;
  };
  DepthSpan span;
  for (const auto& z : known)
    if (z) span.take(z->depth);
  double room = 0.25 * std::max(span.high - span.low, 0.0);
  // one of the two reaches it, and the other's end runs towards it all the way between
  const bool one_way = (a.end.range >= a.begin.range) == (b.end.range >= b.begin.range);
  const bool at_ends = beyond_end(a) || beyond_end(b),
             at_begins = before_begin(a) || before_begin(b);
  const bool runs = one_way && one_of_two && at_ends != at_begins &&
                    (at_ends ? a.d_end * b.d_end > 0.0 : a.d_begin * b.d_begin > 0.0);
  for (const bool ends : {true, false}) {
    if (runs && ends != at_ends) continue;
    const double da = ends ? a.end.depth : a.begin.depth, db = ends ? b.end.depth : b.begin.depth;
    span.take(da);
    span.take(db);
    // between the two the boundary may be deeper, or shallower, by about as much as it changes
    room = std::max(room, std::abs(da - db));
  }
  if (runs) room = std::max(room, 0.25 * (span.high - span.low));
  return {span.low - room, span.high + room};
}

/// The depths of rays that are of one kind with the one of two neighbours that reaches a range.
/// \param way  to the range: next to a caustic slopes are taken to be those of straight rays
DepthSpan around(const ColumnCrossing& known, const std::optional<ColumnCrossing>& middle,
                 double way, double width) noexcept {
  DepthSpan span;
  const auto take = [&](const ColumnCrossing& z) {
    const double room = least_room + 4.0 * std::max(std::abs(z.slope), way) * width;
    span.take(z.depth - room);
    span.take(z.depth + room);
  };
  take(known);
  if (middle) take(*middle);
  return span;
}

/// Whether the depths and slopes of two rays lie on a line, or no receiver is near them.
bool half_tells(const ReceiverColumn& column, const ColumnCrossing& a, const ColumnCrossing& m,
                double width) {
  const double rise = std::abs(m.depth - a.depth);
  const double bend = std::max(std::abs(rise - 0.5 * std::abs(a.slope + m.slope) * width),
                               std::abs(m.slope - a.slope) * 0.125 * width);
  if (bend * m.cosine < tolerance) return true;
  const double margin = 0.5 * rise + 4.0 * bend + tolerance;
  return column.between(std::min(a.depth, m.depth) - margin, std::max(a.depth, m.depth) + margin)
      .empty();
}

/// Whether a leg begins or ends closer to a range than half its extent.
bool near_end(const RayLeg& leg, double range) noexcept {
  return std::min(std::abs(leg.begin.range - range), std::abs(leg.end.range - range)) <
         0.5 * leg.extent() + 10.0;
}

/// Rays whose tube has been spread so thin, or reflected so often, that they are 80 dB below
/// spherical spreading are not followed into finer branches: over rough boundaries there is no end
/// of them.
bool too_faint(const RayLeg& leg, double widest) noexcept {
  const double range = std::max(std::abs(leg.begin.range), 1.0);
  return leg.strength * leg.strength * range < 1e-8 * widest;  // A²r² = R² r cos θ₀/|q|
}

}  // namespace

bool NeighbourTest::holds(const FanRay& a, const FanRay& m, const FanRay& b) const {
  const std::size_t legs = std::max({a.legs.size(), m.legs.size(), b.legs.size()});
  bool evenly = true;  // struck so far: over waves neighbours may strike different crests
  for (std::size_t i = 0; i < legs; ++i) {
    const bool together = i < a.legs.size() && i < m.legs.size() && i < b.legs.size() &&
                          a.legs[i].history == b.legs[i].history &&
                          a.legs[i].history == m.legs[i].history;
    if (!together) return !parting_matters(a, m, b, i);
    if (!leg_holds(a, m, b, i, evenly)) return false;
    evenly = evenly && strikes_evenly(a, m, b, i);
  }
  return true;
}

/// Whether the rays' way, and half as much again to both sides, passes no receiver.
bool NeighbourTest::ends_far_from_receivers(
    std::initializer_list<const FanRay*> rays) const noexcept {
  double low = 1e300, high = -1e300;
  for (const FanRay* ray : rays)
    for (const RayLeg& leg : ray->legs) {
      low = std::min({low, leg.begin.range, leg.end.range});
      high = std::max({high, leg.begin.range, leg.end.range});
    }
  const double room = 0.5 * (high - low);
  const auto reached = std::partition_point(columns_.begin(), columns_.end(),
                                            [&](const auto& c) { return c.range < low - room; });
  return reached == columns_.end() || reached->range > high + room;
}

bool NeighbourTest::regular(const FanRay& a, const FanRay& m, const FanRay& b) const {
  const std::size_t legs = std::min({a.legs.size(), m.legs.size(), b.legs.size()});
  const double last = columns_.back().range;
  if (ends_far_from_receivers({&a, &m, &b})) return true;
  for (std::size_t i = 0; i < legs; ++i) {
    const RayLeg &la = a.legs[i], &lm = m.legs[i], &lb = b.legs[i];
    if (la.history != lb.history || la.history != lm.history) return true;
    if (std::min({la.begin.range, lm.begin.range, lb.begin.range}) > last &&
        std::min({la.end.range, lm.end.range, lb.end.range}) > last)
      continue;
    if (la.turned_in != lm.turned_in || lb.turned_in != lm.turned_in) return false;
    if (!strikes_evenly(a, m, b, i)) return false;
  }
  return true;
}

bool NeighbourTest::pair_tells(const FanRay& a, const FanRay& b) const {
  const double width = b.angle - a.angle;
  const auto straight = [&](double va, double sa, double vb, double sb) {
    return std::abs(vb - va - 0.5 * (sa + sb) * width) < pair_miss &&
           std::abs(sb - sa) * 0.125 * width < pair_miss;
  };
  const std::size_t legs = std::min(a.legs.size(), b.legs.size());
  for (std::size_t i = 0; i < legs; ++i) {
    const RayLeg &la = a.legs[i], &lb = b.legs[i];
    if (la.history != lb.history) return gap_is_clear({&a, &b}, width, i);
    if (la.turned_in != lb.turned_in || la.to_boundary != lb.to_boundary) return false;
    if (la.to_boundary && !straight(la.end.range, la.d_end, lb.end.range, lb.d_end)) return false;
    const auto [first, last] = columns_between(a, b, i, columns_);
    for (std::uint32_t k = first; k < last; ++k) {
      const ReceiverColumn& column = columns_[k];
      const auto za = a.crossing_or_continued(la, k, column.range);
      const auto zb = b.crossing_or_continued(lb, k, column.range);
      if (za && zb && straight(za->depth, za->slope, zb->depth, zb->slope)) continue;
      DepthSpan swept = swept_at(column.range, la, lb, za || zb, {za, zb});
      if (za && zb) {
        const double room = (std::abs(za->slope) + std::abs(zb->slope)) * width;
        swept = {std::min(za->depth, zb->depth) - room, std::max(za->depth, zb->depth) + room};
      }
      if (!column.between(swept.low, swept.high).empty()) return false;
    }
  }
  return a.legs.size() == b.legs.size();
}

/// \param evenly  the legs before end on the boundaries in one way
bool NeighbourTest::leg_holds(const FanRay& a, const FanRay& m, const FanRay& b, std::size_t i,
                              bool evenly) const {
  const RayLeg &la = a.legs[i], &lm = m.legs[i], &lb = b.legs[i];
  if (too_faint(la, std::min(std::abs(la.begin.q), std::abs(la.end.q))) &&
      too_faint(lb, std::min(std::abs(lb.begin.q), std::abs(lb.end.q))))
    return true;
  if (!ends_hold(a, m, b, i)) return false;
  const double width = b.angle - a.angle, seen = seen_at(a, m, b);
  const auto [first, last] = columns_between(a, b, i, columns_);
  for (std::uint32_t k = first; k < last; ++k) {
    const ReceiverColumn& column = columns_[k];
    const auto za = a.crossing_or_continued(la, k, column.range);
    const auto zb = b.crossing_or_continued(lb, k, column.range);
    const auto zm = m.crossing_or_continued(lm, k, column.range);
    if (!za || !zb) {  // too far beyond the end of its leg: are there receivers up to there?
      const DepthSpan swept = la.turned_in != lb.turned_in && za.has_value() != zb.has_value() &&
                                      !near_end(za ? lb : la, column.range)
                                  ? around(za ? *za : *zb, zm, way_to(a, column.range), width)
                                  : swept_at(column.range, la, lb, za || zb, {za, zm, zb});
      if (!column.between(swept.low, swept.high).empty() && !finest_apart(a.angle, b.angle))
        return false;
      // of the half between two that reach it no third ray tells
      if (zm && (za || zb) &&
          !half_tells(column, za ? *za : *zb, *zm, std::abs(m.angle - (za ? a : b).angle)))
        return false;
      continue;
    }
    if (!zm) {  // a and b cross the column with one history, and m does not
      if (!finest_apart(a.angle, b.angle)) return false;
      continue;
    }
    const HermiteNode na{a.angle, za->depth, za->slope}, nm{m.angle, zm->depth, zm->slope},
        nb{b.angle, zb->depth, zb->slope};
    const Hermite cubic(na, nb);
    // the slope tells what a lucky value does not
    const double miss = std::abs(cubic.value(m.angle) - zm->depth) / seen,
                 slope_miss = std::abs(cubic.slope(m.angle) - zm->slope) / seen;
    const double error = std::max(miss, slope_miss * 0.125 * width);
    const bool turns_apart = std::abs(za->turns - zb->turns) > 1;
    // rays that turn in different rows have one between that turns on a knot: a cusp
    const bool one_kind = la.turned_in == lm.turned_in && la.turned_in == lb.turned_in;
    if (error * zm->cosine < (one_kind ? tolerance : cusp_tolerance) && !turns_apart) continue;
    // Rays of one kind that pass the column one below the other: each receiver between them has one
    // root, outside there is none. The halves' slopes are right to a part of what is asked for.
    if (one_kind && evenly && least_rise(na, nm, nb) > 4.0 * miss / width + slope_miss) continue;
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
  if (la.ends_at != lb.ends_at && la.turned_in != lb.turned_in) return true;  // they part there
  const Hermite place({a.angle, la.end.range, la.d_end}, {b.angle, lb.end.range, lb.d_end});
  const double error =
      std::max(std::abs(place.value(m.angle) - lm.end.range),
               std::abs(place.slope(m.angle) - lm.d_end) * 0.125 * (b.angle - a.angle)) /
      seen_at(a, m, b);
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

// Where neighbours of a fan no longer share their history: whether it matters to any receiver.

namespace {

/// Where histories part at a node between two facets, rays reach up to it: what lies between two
/// rays that are closer than this everywhere is left out [m].
constexpr double finest_gap = 1e-4;

/// How far apart rays that part may stay where there is neither a receiver nor a node near [m].
constexpr double narrow_gap = 0.3;

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
      same_boundary = false;  // this ray ends here; rays between may go on
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
  // Rays between the three may reach further, but not many times further.
  const double room = 4.0 * (farthest - nearest), low = turned_back ? nearest - room : nearest;
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
