#include "sonar/scenario/track.h"

#include <algorithm>
#include <cmath>

#include "core/fields.h"
#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {

void Waypoint::describe(Fields& field, const Waypoint* before) {
  const bool held = field.checks() && before != nullptr;
  field(required("time"), time, {.noun = "time", .unit = "s", .low = -1e9, .high = 1e9},
        "since the start of the scenario");
  if (held && time <= before->time)
    field.fault("time", "a time after the waypoint before it, " + to_text(before->time) + " s");
  field(required("position"), position, quantity::coordinate, "where it is then");
  if (!held) return;
  const double speed = (position - before->position).norm() / (time - before->time);
  constexpr double most = quantity::velocity.high;
  if (speed > most)
    field.fault("position", "at most " + to_text(most) + " m/s from the waypoint before it",
                to_text(speed) + " m/s");
}

void Track::describe_waypoints(Fields& field, bool is_live) {
  field(live("waypoints", is_live), waypoints,
        "places at times, the way between two of them straight");
  if (field.checks() && waypoints.empty())
    field.fault("waypoints", "at least one { time, position }");
  if (field.reads()) start.position = waypoints.front().position;
}

void Track::describe(Fields& field, bool is_live) {
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"waypoints"}, !waypoints.empty())) {
    field.excludes("waypoints", {"position", "velocity"});
    describe_waypoints(field, is_live);
  }
  if (const auto way = field.otherwise(ways, {"position", "velocity"})) {
    field(live(required("position"), is_live), start.position, quantity::coordinate,
          "at the start");
    field(live("velocity", is_live), start.velocity, quantity::velocity, "from then on");
  }
}

Kinematics Track::at(double time) const {
  if (waypoints.empty())
    return {.position = start.position + time * start.velocity, .velocity = start.velocity};
  const auto next = std::upper_bound(waypoints.begin(), waypoints.end(), time,
                                     [](double t, const Waypoint& w) { return t < w.time; });
  if (next == waypoints.begin()) return {.position = waypoints.front().position};
  if (next == waypoints.end()) return {.position = waypoints.back().position};
  const Waypoint& from = *std::prev(next);
  const Vec3 velocity = (next->position - from.position) / (next->time - from.time);
  return {.position = from.position + (time - from.time) * velocity, .velocity = velocity};
}

Track Track::since(double time, const Vec3& offset) const {
  Track moved{.start = at(time), .waypoints = waypoints};
  moved.start.position += offset;
  for (Waypoint& point : moved.waypoints) {
    point.time -= time;
    point.position += offset;
  }
  return moved;
}

std::optional<double> Track::course_at(double time) const {
  const auto bearing = [](const Vec3& v) -> std::optional<double> {
    if (v.x() == 0.0 && v.y() == 0.0) return std::nullopt;
    return std::atan2(v.x(), v.y());
  };
  if (waypoints.empty()) return bearing(start.velocity);
  std::optional<double> course;
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    if (course && waypoints[i].time > time) break;
    const auto leg = bearing(waypoints[i + 1].position - waypoints[i].position);
    if (leg) course = leg;
  }
  return course;
}

}  // namespace asdic::detail
