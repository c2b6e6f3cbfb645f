#include "sonar/processing/passage.h"

#include <algorithm>
#include <iterator>

namespace asdic {

Kinematics Passage::at(double time) const {
  const auto next = std::upper_bound(turns.begin(), turns.end(), time,
                                     [](double t, const Turn& turn) { return t < turn.time; });
  if (next == turns.begin()) return {.position = position + time * velocity, .velocity = velocity};
  const Turn& last = *std::prev(next);
  return {.position = last.from.after(time - last.time), .velocity = last.from.velocity};
}

Passage passage_of_array(const Scenario& scenario, int array, double time) {
  Passage passage = array_at(scenario, array, time);
  const int platform = scenario.arrays[static_cast<std::size_t>(array)].platform;
  const Track& track = scenario.platforms[static_cast<std::size_t>(platform)].track;
  for (const Waypoint& point : track.waypoints)
    if (point.time > time)
      passage.turns.push_back(
          {.time = point.time - time, .from = array_at(scenario, array, point.time)});
  return passage;
}

}  // namespace asdic
