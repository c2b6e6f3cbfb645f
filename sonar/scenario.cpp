#include "sonar/scenario.h"

#include <algorithm>
#include <cmath>

#include "sonar/geometry.h"

namespace asdic {
namespace {

Kinematics on_platform(const Scenario& scenario, int platform, const Vec3& offset, double time) {
  Kinematics place = scenario.platforms[static_cast<std::size_t>(platform)].track.at(time);
  place.position += offset;
  return place;
}

}  // namespace

Kinematics transmitter_at(const Scenario& scenario, int transmitter, double time) {
  const Transmitter& one = scenario.transmitters[static_cast<std::size_t>(transmitter)];
  return on_platform(scenario, one.platform, one.offset, time);
}

Kinematics array_at(const Scenario& scenario, int array, double time) {
  const ReceiverArray& one = scenario.arrays[static_cast<std::size_t>(array)];
  return on_platform(scenario, one.platform, one.offset, time);
}

double platform_heading(const Scenario& scenario, int platform, double time) {
  const Track& track = scenario.platforms[static_cast<std::size_t>(platform)].track;
  return track.course_at(time).value_or(0.0);
}

namespace {

/// A place on a track's path, `behind` its place at a time; straight on backwards where the path
/// has not begun.
Vec3 on_the_path(const Track& track, double time, double behind, double heading) {
  const Vec3 here = track.at(time).position;
  if (track.waypoints.empty()) {
    const double speed = track.start.velocity.norm();
    const Vec3 ahead = speed > 0.0 ? Vec3(track.start.velocity / speed) : direction(heading, 0.0);
    return here - behind * ahead;
  }
  Vec3 from = here;
  double left = behind;
  Vec3 ahead = direction(track.course_at(time).value_or(heading), 0.0);
  for (auto point = track.waypoints.rbegin(); point != track.waypoints.rend(); ++point) {
    if (point->time >= time) continue;
    const double length = (from - point->position).norm();
    if (length == 0.0) continue;
    ahead = (from - point->position) / length;
    if (left <= length) return from - left * ahead;
    left -= length;
    from = point->position;
  }
  // What lies before the first waypoint goes on as the first leg does.
  for (std::size_t i = 0; i + 1 < track.waypoints.size(); ++i) {
    const Vec3 leg = track.waypoints[i + 1].position - track.waypoints[i].position;
    if (leg.norm() == 0.0) continue;
    ahead = leg.normalized();
    break;
  }
  return from - left * ahead;
}

}  // namespace

std::vector<Vec3> phones_at(const Scenario& scenario, int array, int ping, double time) {
  const ReceiverArray& one = scenario.arrays[static_cast<std::size_t>(array)];
  if (one.towed) {
    const Track& track = scenario.platforms[static_cast<std::size_t>(one.platform)].track;
    const Vec3 here = track.at(time).position;
    std::vector<Vec3> phones;
    for (const double behind : one.towed->behind)
      phones.push_back(on_the_path(track, time, behind, one.towed->heading) - here);
    return phones;
  }
  if (one.shapes.empty()) return one.phones;
  return one.shapes[static_cast<std::size_t>(ping - 1) % one.shapes.size()];
}

const PulseSettings& pulse_of(const Scenario& scenario, int transmitter) {
  const Transmitter& one = scenario.transmitters[static_cast<std::size_t>(transmitter)];
  return one.pulse ? *one.pulse : scenario.pulse;
}

std::size_t channels_of(const Scenario& scenario) {
  return first_channel(scenario, static_cast<int>(scenario.arrays.size()));
}

std::size_t first_channel(const Scenario& scenario, int array) {
  std::size_t channels = 0;
  for (int i = 0; i < array; ++i)
    channels += scenario.arrays[static_cast<std::size_t>(i)].phones.size();
  return channels;
}

}  // namespace asdic
