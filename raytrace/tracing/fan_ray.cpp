#include "raytrace/tracing/fan_ray.h"

#include <algorithm>
#include <cmath>

namespace asdic {
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

/// What a bounce adds to the history: which boundary and, where its tangent jumps, which facet.
std::uint64_t bounce_event(const Boundary& boundary, bool bottom, double range) noexcept {
  std::uint64_t facet = 0;
  if (boundary.shape && boundary.shape->interpolation() == ShapeInterpolation::piecewise_linear)
    facet = boundary.shape->facet(range);
  return 4 * facet + (bottom ? 2 : 1);
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
  const double c = 1.0 / std::hypot(xi, zeta);
  return {.depth = depth, .slope = sign * q / (c * xi), .cosine = std::abs(c * xi), .turns = turns};
}

bool forward(const RaySegment& s) noexcept { return s.end.range >= s.begin.range; }

/// The sign of q just after a segment's begin.
double sense_of(const RaySegment& s) noexcept { return s.begin.q != 0.0 ? s.begin.q : s.begin.p; }

int bounces(const RaySegment& s) noexcept {
  return s.history.surface_bounces + s.history.bottom_bounces;
}

double sign_after(int bounces) noexcept { return bounces % 2 == 0 ? -1.0 : 1.0; }

/// Calls visit(leg index, history, first segment, one past its last segment) for every leg in turn,
/// until it returns false.
template <class Visit>
void for_each_leg(const RayTrajectory& ray, const Environment& environment, Visit&& visit) {
  const auto& segments = ray.segments;
  std::uint64_t history = 0;
  std::size_t first = 0, leg = 0;
  for (std::size_t i = 1; i <= segments.size(); ++i) {
    const bool last = i == segments.size();
    const bool bounced = !last && bounces(segments[i]) != bounces(segments[i - 1]);
    if (!last && !bounced && forward(segments[i]) == forward(segments[i - 1])) continue;
    if (!visit(leg++, history, first, i)) return;
    if (last) return;
    if (bounced) {
      const bool bottom =
          segments[i].history.bottom_bounces != segments[i - 1].history.bottom_bounces;
      history = mixed(history, bounce_event(bottom ? environment.bottom : environment.surface,
                                            bottom, segments[i].begin.range));
    } else {
      history = mixed(history, turned_back);
    }
    first = i;
  }
}

}  // namespace

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

void digest(const RayTrajectory& ray, const Environment& environment,
            std::span<const ReceiverColumn> columns, FanRay& out) {
  out.angle = ray.launch_elevation;
  out.ended = ray.ended;
  out.legs.clear();
  out.crossings.clear();
  const auto& segments = ray.segments;
  for_each_leg(
      ray, environment,
      [&](std::size_t, std::uint64_t history, std::size_t first, std::size_t last) {
        const RaySegment &head = segments[first], &tail = segments[last - 1];
        RayLeg leg{.history = history, .begin = begin_of(head), .end = end_of(tail)};
        leg.sign = sign_after(bounces(head));
        leg.strength = std::abs(head.history.reflection);
        leg.from_boundary =
            bounces(head) > 0 && (first == 0 || bounces(segments[first - 1]) < bounces(head));
        leg.to_boundary = last < segments.size()
                              ? bounces(segments[last]) > bounces(tail)
                              : ray.ended != RayEnd::box && ray.ended != RayEnd::trapped;
        leg.turns_begin = head.history.upper_turns + head.history.lower_turns;
        leg.turns_end = tail.history.upper_turns + tail.history.lower_turns;
        leg.first_crossing = static_cast<std::uint32_t>(out.crossings.size());
        const auto cross = [&](const RaySegment& s, std::uint32_t column) {
          const RayState y = state_at(s, arc_at_range(s, columns[column].range));
          out.crossings.push_back(crossing_of(y.depth, y.xi, y.zeta, y.q, leg.sign,
                                              s.history.upper_turns + s.history.lower_turns));
        };
        const auto at_least = [&](double range) {
          return static_cast<std::uint32_t>(
              std::partition_point(columns.begin(), columns.end(),
                                   [&](const ReceiverColumn& c) { return c.range < range; }) -
              columns.begin());
        };
        const auto above = [&](double range) {
          return static_cast<std::uint32_t>(
              std::partition_point(columns.begin(), columns.end(),
                                   [&](const ReceiverColumn& c) { return c.range <= range; }) -
              columns.begin());
        };
        if (forward(head)) {  // [begin, end)
          leg.first_column = leg.last_column = at_least(leg.begin.range);
          for (std::size_t i = first; i < last; ++i)
            while (leg.last_column < columns.size() &&
                   columns[leg.last_column].range < segments[i].end.range)
              cross(segments[i], leg.last_column++);
        } else {  // (end, begin], stored by increasing range
          leg.first_column = leg.last_column = above(leg.begin.range);
          for (std::size_t i = first; i < last; ++i)
            while (leg.first_column > 0 &&
                   columns[leg.first_column - 1].range > segments[i].end.range)
              cross(segments[i], --leg.first_column);
          std::reverse(out.crossings.begin() + leg.first_crossing, out.crossings.end());
        }
        out.legs.push_back(leg);
        return true;
      });
}

std::optional<ExactCrossing> cross_column(const RayTrajectory& ray, const Environment& environment,
                                          std::size_t leg, std::uint64_t history, double range) {
  std::optional<ExactCrossing> found;
  const auto& segments = ray.segments;
  for_each_leg(
      ray, environment,
      [&](std::size_t index, std::uint64_t this_history, std::size_t first, std::size_t last) {
        if (index < leg) return true;
        if (this_history != history) return false;
        const RaySegment &head = segments[first], &tail = segments[last - 1];
        const double sign = sign_after(bounces(head));
        const bool onward = forward(head);
        const auto within = [&](const RaySegment& s) {
          return onward ? range < s.end.range : range > s.end.range;
        };
        const double behind = onward ? head.begin.range - range : range - head.begin.range;
        const double beyond = onward ? range - tail.end.range : tail.end.range - range;
        found.emplace();
        if (behind > 0.0) {  // the leg begins after the column
          found->state = head.begin;
          found->history = head.history;
          found->c = head.c_begin;
          found->real = behind < on_boundary;
          found->crossing = begin_of(head).continued_to(range, sign);
        } else if (beyond >= 0.0) {  // or ends before it
          found->state = tail.end;
          found->history = tail.history;
          found->c = tail.c_end;
          found->real = beyond < on_boundary;
          if (sense_of(tail) * tail.end.q < 0.0) ++found->history.caustics;
          found->crossing = end_of(tail).continued_to(range, sign);
        } else {
          const auto s = std::find_if(segments.begin() + static_cast<std::ptrdiff_t>(first),
                                      segments.begin() + static_cast<std::ptrdiff_t>(last), within);
          found->state = state_at(*s, arc_at_range(*s, range));
          found->history = s->history;
          found->c = 1.0 / std::hypot(found->state.xi, found->state.zeta);
          found->real = true;
          const RayState& y = found->state;
          found->crossing = crossing_of(y.depth, y.xi, y.zeta, y.q, sign, 0);
          if (sense_of(*s) * y.q < 0.0) ++found->history.caustics;
        }
        return false;
      });
  return found;
}

}  // namespace asdic
