#include "sonar/track.h"

#include <algorithm>

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

}  // namespace asdic
