#include "sonar/paths/moving_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry.h"

namespace asdic::detail {
namespace {

/// When a path that starts at `start` reaches the end of its way, which has moved since the
/// reference time: t = start + τ + s·v(t − t_ref).
double arrival_time(const Way& way, double start, const Arrival& path, const Vec3& slowness) {
  const double along = slowness.dot(way.end.velocity);
  return (start + path.delay - along * way.reference_time) / (1.0 - along);
}

}  // namespace

Vec3 slowness_vector(double bearing, double elevation, double sound_speed) {
  return direction(bearing, elevation) / sound_speed;
}

Vec3 leaving_slowness(double line, const Arrival& path, double sound_speed) {
  return slowness_vector(launch_bearing(path, line), path.launch_elevation, sound_speed);
}

Vec3 arriving_slowness(double line, const Arrival& path, double sound_speed) {
  return slowness_vector(arrival_bearing(path, line), path.arrival_elevation, sound_speed);
}

const Arrival* same_path(const Arrivals& arrivals, const Arrival& path, bool layered) {
  constexpr double near = radians(1.0);
  const double near_level = 1.0 - std::cos(2.0 * near);  // Δξ/ξ of a level ray turned by that
  constexpr double near_alone = radians(10.0);           // where there is one of that history only
  const Arrival* nearest = nullptr;
  double least = infinity, turn_of_nearest = infinity;
  int of_history = 0;
  for (const Arrival& a : arrivals) {
    // Beside a caustic a ray stays what it is.
    if ((a.kind == ArrivalKind::diffracted) != (path.kind == ArrivalKind::diffracted) ||
        a.surface_bounces != path.surface_bounces || a.bottom_bounces != path.bottom_bounces ||
        a.upper_turns != path.upper_turns || a.lower_turns != path.lower_turns)
      continue;
    ++of_history;
    const double aside = std::remainder(a.launch_deflection - path.launch_deflection, 2.0 * pi) *
                         std::cos(path.launch_elevation);
    const double turned = std::hypot(a.launch_elevation - path.launch_elevation, aside);
    const double changed =  // of ξ, over ξ; straight up and down there is none
        std::abs(a.horizontal_slowness - path.horizontal_slowness) /
        std::max(path.horizontal_slowness, std::numeric_limits<double>::min());
    const bool one_way = (a.launch_elevation < 0.0) == (path.launch_elevation < 0.0);
    // Without a turn r(ξ) of a history grows with ξ: there is one such path only.
    const bool only_one = layered && one_way && path.upper_turns + path.lower_turns == 0;
    if (!(turned < (layered ? near : near_alone) || only_one ||
          (layered && one_way && changed < near_level)))
      continue;
    const bool other_of_pair = a.kind == ArrivalKind::caustic &&
                               path.kind == ArrivalKind::caustic && a.caustics != path.caustics;
    const double difference =
        (layered ? changed + (one_way ? 0.0 : 1.0) : turned) + (other_of_pair ? 1.0 : 0.0);
    if (difference < least) {
      least = difference;
      turn_of_nearest = turned;
      nearest = &a;
    }
  }
  return layered || of_history == 1 || turn_of_nearest < near ? nearest : nullptr;
}

Kinematics MovingPaths::place(const Track& track, const Vec3& offset, double time) const {
  Kinematics k = track.at(ping_time_ + time);
  k.position += offset;
  return k;
}

Way MovingPaths::way_at(const Vec3& from, const Track& track, const Vec3& offset, double time,
                        std::span<const Arrival> known) const {
  Way way;
  way.end = place(track, offset, time);
  way.reference_time = time;
  const Vec3& to = way.end.position;
  const Separation s = separation(from, to);
  way.leg.bearing = s.bearing;
  way.leg.range = s.range;
  way.leg.end = to.head<2>();
  way.leg.arrivals = known.empty() ? paths_.find(from, to, frequency_, limits_, reuse_)
                                   : paths_.follow(known, from, to, frequency_, limits_, reuse_);
  return way;
}

/// When sound that left along a straight line would be there: off by the changes of its speed.
double MovingPaths::straight_arrival(const Vec3& from, double start, const Track& track,
                                     const Vec3& offset) const {
  const double c = paths_.speed_at(from);
  double time = start;
  for (int i = 0; i < 3; ++i)
    time = start + (place(track, offset, time).position - from).norm() / c;
  return time;
}

Way MovingPaths::way(const Vec3& from, double start, const Track& track, const Vec3& offset,
                     std::span<const Arrival> known) const {
  const double guess =
      known.empty() ? straight_arrival(from, start, track, offset) : start + known.front().delay;
  Way way = way_at(from, track, offset, guess, known);
  for (int i = 0; i < 4 && !way.leg.arrivals.empty(); ++i) {
    const Arrival& first = way.leg.arrivals.front();
    const double c = paths_.speed_at(way.end.position);
    const double time =
        arrival_time(way, start, first, arriving_slowness(way.leg.bearing, first, c));
    const Kinematics then = place(track, offset, time);
    const double moved = (then.position - way.end.position).norm();
    // Beyond a turn neither the linear step nor the Doppler factor is that of the course before.
    constexpr double same_course = 1e-6;  // [m/s]
    if (settled(moved, c, std::max(way.leg.range, moved)) &&
        (moved == 0.0 || (then.velocity - way.end.velocity).norm() < same_course)) {
      if (moved == 0.0) {
        way.end = then;
        way.reference_time = time;
      }
      break;
    }
    // The first step may be a long one.
    const Arrivals before = i == 0 && known.empty() ? Arrivals{} : std::move(way.leg.arrivals);
    way = way_at(from, track, offset, time, before);
  }
  return way;
}

/// The linear step neglects the curvature of τ, d²/(2rc) for a displacement d: less than the
/// tolerance? Over slopes it also neglects that the plane turns with the end, a slowness across the
/// plane of the order of the slope times sin θ/c: a millimetre of displacement is less than 0.1 µs.
bool MovingPaths::settled(double moved, double c, double range) const {
  if (!paths_.layered()) return moved <= 1e4 * tolerance_;
  return moved * moved <= tolerance_ * 2.0 * c * range;
}

MetPath MovingPaths::meet(const Vec3& from, double start, const Track& track, const Vec3& offset,
                          const Way& reference, const Arrival& path) const {
  MetPath met{.way = {.leg = {.kind = reference.leg.kind,
                              .target = reference.leg.target,
                              .array = reference.leg.array,
                              .channel = reference.leg.channel,
                              .bearing = reference.leg.bearing,
                              .range = reference.leg.range,
                              .arrivals = {}},
                      .end = reference.end,
                      .reference_time = reference.reference_time},
              .path = path};
  for (int i = 0; i < 4; ++i) {
    const double c = paths_.speed_at(met.way.end.position);
    met.time =
        arrival_time(met.way, start, met.path, arriving_slowness(met.way.leg.bearing, met.path, c));
    const Kinematics then = place(track, offset, met.time);
    const double moved = (then.position - met.way.end.position).norm();
    if (settled(moved, c, std::max(met.way.leg.range, moved))) break;
    Way again = way_at(from, track, offset, met.time, std::span(&met.path, 1));
    const Arrival* same = same_path(again.leg.arrivals, met.path, paths_.layered());
    if (same == nullptr) break;
    met.path = *same;
    met.way = std::move(again);
    met.way.leg.arrivals.clear();
  }
  return met;
}

}  // namespace asdic::detail
