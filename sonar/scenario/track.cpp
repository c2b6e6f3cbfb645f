#include "sonar/scenario/track.h"

#include <algorithm>
#include <cmath>

namespace asdic {

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

}  // namespace asdic
