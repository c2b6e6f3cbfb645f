#include "raytrace/tracing/fan_ray.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

/// How far a leg is continued beyond its ends, as a part of its extent; and at least this [m].
constexpr double longest_continuation = 0.25, least_continuation = 1.0;

/// A receiver this close to the end of a leg lies on the boundary [m].
constexpr double on_boundary = 1e-3;

std::uint64_t mixed(std::uint64_t history, std::uint64_t event) noexcept {  // splitmix64
  std::uint64_t x = history + 0x9e3779b97f4a7c15U * (event + 1);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

constexpr std::uint64_t turned_back = 3;  // an event: neither 1 nor 2 modulo 4

LegEnd begin_of(const RaySegment& s) noexcept {
  return {s.begin.range, s.begin.depth, s.begin.xi,  s.begin.zeta, s.begin.q,
          s.begin.p,     s.c_begin,     s.c_r_begin, s.c_z_begin};
}

LegEnd end_of(const RaySegment& s) noexcept {
  return {s.end.range, s.end.depth, s.end.xi,  s.end.zeta, s.end.q,
          s.end.p,     s.c_end,     s.c_r_end, s.c_z_end};
}

/// ∂z/∂α at fixed range: the ray moves by q·dα along its normal, which leans by θ.
ColumnCrossing crossing_of(double depth, double xi, double zeta, double q, double sign, int turns) {
  const double c = 1.0 / std::sqrt(xi * xi + zeta * zeta);
  return {.depth = depth, .slope = sign * q / (c * xi), .cosine = std::abs(c * xi), .turns = turns};
}

bool forward(const RaySegment& s) noexcept { return s.end.range >= s.begin.range; }

/// The sign of q just after a segment's begin.
double sense_of(const RaySegment& s) noexcept { return s.begin.q != 0.0 ? s.begin.q : s.begin.p; }

/// Whether a reflection between two segments moved the ray along the boundary.
bool displaced(const RaySegment& before, const RaySegment& after) noexcept {
  return before.end.range != after.begin.range;
}

int turns(const RaySegment& s) noexcept { return s.history.upper_turns + s.history.lower_turns; }

int bounces(const RaySegment& s) noexcept {
  return s.history.surface_bounces + s.history.bottom_bounces;
}

std::uint32_t columns_below(std::span<const ReceiverColumn> columns, double range) {
  const auto at = std::partition_point(columns.begin(), columns.end(),
                                       [&](const ReceiverColumn& c) { return c.range < range; });
  return static_cast<std::uint32_t>(at - columns.begin());
}

std::uint32_t columns_up_to(std::span<const ReceiverColumn> columns, double range) {
  const auto at = std::partition_point(columns.begin(), columns.end(),
                                       [&](const ReceiverColumn& c) { return c.range <= range; });
  return static_cast<std::uint32_t>(at - columns.begin());
}

}  // namespace

std::uint64_t history_after(std::uint64_t history, const Boundary& boundary, BoundaryKind kind,
                            double range) noexcept {
  std::uint64_t facet = 0;
  if (boundary.shape && boundary.shape->interpolation() == ShapeInterpolation::piecewise_linear)
    facet = boundary.shape->facet(range);
  return mixed(history, 4 * facet + (kind == BoundaryKind::bottom ? 2 : 1));
}

double mirror_sign(const RayHistory& history) noexcept {
  return (history.surface_bounces + history.bottom_bounces) % 2 == 0 ? 1.0 : -1.0;
}

void split_into_legs(const RayTrajectory& ray, const Environment& environment,
                     std::vector<LegOfRay>& out) {
  const auto& segments = ray.segments;
  out.clear();
  std::uint64_t history = 0;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= segments.size(); ++i) {
    const bool last = i == segments.size();
    const bool bounced = !last && bounces(segments[i]) != bounces(segments[i - 1]);
    if (!last && !bounced && forward(segments[i]) == forward(segments[i - 1])) continue;
    out.push_back({history, first, i});
    if (last) return;
    if (bounced) {
      const bool bottom =
          segments[i].history.bottom_bounces != segments[i - 1].history.bottom_bounces;
      const Boundary& wall = bottom ? environment.bottom : environment.surface;
      const BoundaryKind kind = bottom ? BoundaryKind::bottom : BoundaryKind::surface;
      history = history_after(history, wall, kind, segments[i - 1].end.range);
      if (displaced(segments[i - 1], segments[i]))
        history = history_after(history, wall, kind, segments[i].begin.range);
      // where speed changes with range, between rays that leave forward and backward some do the
      // one and turn back to the other
      if (environment.section && forward(segments[i]) != forward(segments[i - 1]))
        history = mixed(history, turned_back);
    } else {
      history = mixed(history, turned_back);
    }
    first = i;
  }
}

ColumnCrossing LegEnd::continued_to(double target, double sign) const noexcept {
  const double step = target - range;
  const double per_range = -1.0 / (c * c * c * xi);  // dξ/dr = −c_r/(c³ξ), dζ/dr = −c_z/(c³ξ)
  const double xi_r = c_r * per_range, zeta_r = c_z * per_range;
  const double bend = (zeta_r * xi - zeta * xi_r) / (xi * xi);  // d²z/dr²
  return crossing_of(depth + step * (zeta / xi + 0.5 * bend * step), xi + xi_r * step,
                     zeta + zeta_r * step, q + p * step / xi, sign, 0);
}

double RayLeg::extent() const noexcept { return std::abs(end.range - begin.range); }

std::optional<ColumnCrossing> FanRay::crossing_or_continued(const RayLeg& leg, std::uint32_t column,
                                                            double range) const noexcept {
  if (leg.covers(column)) return crossing(leg, column);
  const double reach = longest_continuation * leg.extent() + least_continuation;
  const bool onward = (range >= leg.end.range) == (leg.end.range >= leg.begin.range);
  const LegEnd& near = onward ? leg.end : leg.begin;
  if (!(onward ? leg.to_boundary : leg.from_boundary)) return {};
  if (std::abs(range - near.range) > reach || near.xi == 0.0) return {};
  ColumnCrossing there = near.continued_to(range, leg.sign);
  if (!std::isfinite(there.slope)) return {};
  there.turns = leg.turns_at(onward);
  return there;
}

double position_slope(const Boundary& boundary, double range) noexcept {
  if (!boundary.shape) return 0.0;
  if (boundary.shape->interpolation() == ShapeInterpolation::smooth)
    return boundary.shape->at(range).slope;
  const std::size_t facet = boundary.shape->facet(range);  // straight, whatever reflects
  return boundary.shape->depth_at(range + 0.5, facet) -
         boundary.shape->depth_at(range - 0.5, facet);
}

double range_per_angle(const LegEnd& end, const Boundary& boundary, double sign) noexcept {
  // With u the boundary's tangent and n = c(ζ, −ξ) the beam's normal, u·dℓ = n·(∓q dα) + t·ds, so
  // dℓ = ∓q dα/(u·n) and dr = u_r dℓ.
  const double slope = position_slope(boundary, end.range);  // u_z/u_r
  const double across = end.c * (end.zeta - slope * end.xi);
  return across != 0.0 ? -sign * end.q / across : 0.0;
}

void digest(const RayTrajectory& ray, const Environment& environment,
            std::span<const ReceiverColumn> columns, FanRay& out) {
  out.angle = ray.launch_elevation;
  out.ended = ray.ended;
  out.legs.clear();
  out.crossings.clear();
  split_into_legs(ray, environment, out.parts);
  const auto& segments = ray.segments;
  const bool at_boundary = ray.ended != RayEnd::box && ray.ended != RayEnd::trapped;
  std::uint64_t turned_in = 0;
  for (const auto& [history, first, last] : out.parts) {
    const RaySegment &head = segments[first], &tail = segments[last - 1];
    RayLeg leg{.history = history, .begin = begin_of(head), .end = end_of(tail)};
    leg.sign = -mirror_sign(head.history);
    leg.strength = std::abs(head.history.reflection);
    if (head.history.scattered > 0.0)
      leg.strength = std::sqrt(leg.strength * leg.strength + head.history.scattered);
    leg.from_boundary =
        bounces(head) > 0 && (first == 0 || bounces(segments[first - 1]) < bounces(head));
    leg.to_boundary =
        last < segments.size() ? bounces(segments[last]) > bounces(tail) : at_boundary;
    if (leg.from_boundary && !out.legs.empty()) leg.d_begin = out.legs.back().d_end;
    if (leg.from_boundary && static_cast<std::size_t>(bounces(head)) <= ray.bounces.size())
      leg.begins_at = ray.bounces[static_cast<std::size_t>(bounces(head)) - 1].boundary;
    if (leg.from_boundary && first > 0 && displaced(segments[first - 1], head))
      leg.d_begin = range_per_angle(
          leg.begin,
          leg.begins_at == BoundaryKind::surface ? environment.surface : environment.bottom,
          leg.sign);
    if (leg.to_boundary) {
      const auto bounce = static_cast<std::size_t>(bounces(head));
      const bool surface = bounce < ray.bounces.size()
                               ? ray.bounces[bounce].boundary == BoundaryKind::surface
                               : tail.end.zeta < 0.0;
      leg.ends_at = surface ? BoundaryKind::surface : BoundaryKind::bottom;
      leg.d_end =
          range_per_angle(leg.end, surface ? environment.surface : environment.bottom, leg.sign);
    }
    leg.turns_begin = head.history.upper_turns + head.history.lower_turns;
    leg.turns_end = tail.history.upper_turns + tail.history.lower_turns;
    for (std::size_t i = first; leg.turns_end > leg.turns_begin && i + 1 < last; ++i)
      if (turns(segments[i + 1]) != turns(segments[i]))
        turned_in = mixed(turned_in, segments[i].row);
    leg.turned_in = turned_in;
    leg.first_crossing = static_cast<std::uint32_t>(out.crossings.size());
    const auto cross = [&](const RaySegment& s, const SegmentCurve& curve, std::uint32_t column) {
      const auto y = curve.at_range(columns[column].range);
      out.crossings.push_back(crossing_of(y.depth, y.xi, y.zeta, y.q, leg.sign,
                                          s.history.upper_turns + s.history.lower_turns));
    };
    if (forward(head)) {  // [begin, end)
      leg.first_column = leg.last_column = columns_below(columns, leg.begin.range);
      for (std::size_t i = first; i < last; ++i) {
        const RaySegment& s = segments[i];
        const auto passed = [&] {
          return leg.last_column < columns.size() && columns[leg.last_column].range < s.end.range;
        };
        if (!passed()) continue;
        const SegmentCurve curve(s);
        while (passed()) cross(s, curve, leg.last_column++);
      }
    } else {  // (end, begin], stored by increasing range
      leg.first_column = leg.last_column = columns_up_to(columns, leg.begin.range);
      for (std::size_t i = first; i < last; ++i) {
        const RaySegment& s = segments[i];
        const auto passed = [&] {
          return leg.first_column > 0 && columns[leg.first_column - 1].range > s.end.range;
        };
        if (!passed()) continue;
        const SegmentCurve curve(s);
        while (passed()) cross(s, curve, --leg.first_column);
      }
      std::reverse(out.crossings.begin() + leg.first_crossing, out.crossings.end());
    }
    out.legs.push_back(leg);
  }
}

std::optional<ExactCrossing> cross_column(const RayTrajectory& ray, const RayTracer& tracer,
                                          std::size_t leg, std::uint64_t history, double range) {
  thread_local std::vector<LegOfRay> parts;
  split_into_legs(ray, tracer.environment(), parts);
  if (leg >= parts.size() || parts[leg].history != history) return {};
  return cross_leg(ray, tracer, parts[leg], range);
}

ExactCrossing cross_leg(const RayTrajectory& ray, const RayTracer& tracer, const LegOfRay& leg,
                        double range) {
  const std::span<const RaySegment> segments(ray.segments.data() + leg.first, leg.last - leg.first);
  const RaySegment &head = segments.front(), &tail = segments.back();
  const double sign = -mirror_sign(head.history);
  const bool onward = forward(head);
  const double behind = onward ? head.begin.range - range : range - head.begin.range;
  const double beyond = onward ? range - tail.end.range : tail.end.range - range;
  ExactCrossing found;
  if (behind > 0.0) {  // the leg begins after the column
    found.state = head.begin;
    found.history = head.history;
    found.c = head.c_begin;
    found.real = behind < on_boundary;
    found.crossing = begin_of(head).continued_to(range, sign);
  } else if (beyond >= 0.0) {  // or ends before it
    found.state = tail.end;
    found.history = tail.history;
    found.c = tail.c_end;
    found.real = beyond < on_boundary;
    if (sense_of(tail) * tail.end.q < 0.0) ++found.history.caustics;
    found.crossing = end_of(tail).continued_to(range, sign);
  } else {
    const RaySegment& s = *std::find_if(segments.begin(), segments.end(), [&](const RaySegment& x) {
      return onward ? range < x.end.range : range > x.end.range;
    });
    const RayState y = tracer.state_at_range(s, range);
    found.state = y;
    found.history = s.history;
    found.row = s.row;
    found.c = 1.0 / std::sqrt(y.xi * y.xi + y.zeta * y.zeta);
    found.real = true;
    if (sense_of(s) * y.q < 0.0) ++found.history.caustics;
    found.crossing = crossing_of(y.depth, y.xi, y.zeta, y.q, sign, 0);
  }
  return found;
}

}  // namespace asdic::detail
