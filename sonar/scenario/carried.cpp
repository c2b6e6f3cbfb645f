// Where an array's phones and their middle are, and how they move.
#include "sonar/scenario/carried.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry.h"

namespace asdic::detail {
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

/// When the tow point has come `behind` farther than each corner of its path: whatever trails it so
/// far behind passes the corner then.
std::vector<double> corner_times(const std::vector<Waypoint>& corners, double behind) {
  std::vector<double> come{0.0};  // along the path, at each corner
  for (std::size_t i = 1; i < corners.size(); ++i)
    come.push_back(come.back() + (corners[i].position - corners[i - 1].position).norm());
  std::vector<double> times;
  for (const double corner : come) {
    const auto after = std::upper_bound(come.begin(), come.end(), corner + behind);
    if (after == come.begin() || after == come.end()) continue;
    const auto i = static_cast<std::size_t>(after - come.begin());
    const double share = (corner + behind - come[i - 1]) / (come[i] - come[i - 1]);
    times.push_back(std::lerp(corners[i - 1].time, corners[i].time, share));
  }
  return times;
}

/// The track of what is drawn along a track's path, `behind` its place: straight and of one speed
/// but where the tow point or it passes a corner.
Track trailing(const Track& tow, double behind, double heading) {
  Track track = tow;
  if (tow.waypoints.empty()) {
    track.start.position = on_the_path(tow, 0.0, behind, heading);
    return track;
  }
  std::vector<double> times = corner_times(tow.waypoints, behind);
  for (const Waypoint& corner : tow.waypoints) times.push_back(corner.time);
  std::sort(times.begin(), times.end());
  constexpr double shortest = 1e-6;  // [s], between waypoints that are resolved
  const auto same = [](double a, double b) { return b - a < shortest; };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  track.waypoints.clear();
  for (const double time : times)
    track.waypoints.push_back({time, on_the_path(tow, time, behind, heading)});
  return track;
}

double mean_behind(const TowedLine& line, PhoneRange phones) {
  const auto first = line.behind.begin() + static_cast<std::ptrdiff_t>(phones.first);
  return std::accumulate(first, first + static_cast<std::ptrdiff_t>(phones.count), 0.0) /
         static_cast<double>(phones.count);
}

double mean_behind(const TowedLine& line) { return mean_behind(line, {0, line.behind.size()}); }

/// The middle of phones that are not towed, as they are given; exactly zero where it is so but for
/// rounding.
Vec3 middle_of(const ReceiverArray& array) {
  const std::vector<std::vector<Vec3>> one{array.phones};
  Vec3 sum = Vec3::Zero();
  double count = 0.0, farthest = 0.0;
  for (const std::vector<Vec3>& shape : array.shapes.empty() ? one : array.shapes)
    for (const Vec3& phone : shape) {
      sum += phone;
      count += 1.0;
      farthest = std::max(farthest, phone.norm());
    }
  constexpr double rounding = 1e-12;
  return sum.norm() <= rounding * count * farthest ? Vec3::Zero() : Vec3(sum / count);
}

const ReceiverArray& array_of(const Scenario& scenario, int array) {
  return scenario.arrays[static_cast<std::size_t>(array)];
}

const Track& carrier_of(const Scenario& scenario, int array) {
  return scenario.platforms[static_cast<std::size_t>(array_of(scenario, array).platform)].track;
}

/// As given, of one that is not towed.
const std::vector<Vec3>& given_phones(const ReceiverArray& array, int ping) {
  if (array.shapes.empty()) return array.phones;
  return array.shapes[static_cast<std::size_t>(ping - 1) % array.shapes.size()];
}

}  // namespace

Carried reference_of(const Scenario& scenario, int array) {
  const ReceiverArray& one = array_of(scenario, array);
  const Track& carrier = carrier_of(scenario, array);
  if (one.towed)
    return {trailing(carrier, mean_behind(*one.towed), one.towed->heading), one.offset};
  return {carrier, one.offset + middle_of(one)};
}

Carried middle_of(const Scenario& scenario, int array, int ping, PhoneRange phones) {
  const ReceiverArray& one = array_of(scenario, array);
  const Track& carrier = carrier_of(scenario, array);
  if (one.towed)
    return {trailing(carrier, mean_behind(*one.towed, phones), one.towed->heading), one.offset};
  const std::vector<Vec3>& given = given_phones(one, ping);
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < phones.count; ++n) sum += given[phones.first + n];
  return {carrier, one.offset + sum / static_cast<double>(phones.count)};
}

Carried phone_of(const Scenario& scenario, int array, int ping, int phone) {
  return middle_of(scenario, array, ping, {static_cast<std::size_t>(phone), 1});
}

bool deforms(const Scenario& scenario, int array) {
  return array_of(scenario, array).towed && carrier_of(scenario, array).waypoints.size() > 2;
}

Kinematics array_at(const Scenario& scenario, int array, double time) {
  return reference_of(scenario, array).at(time);
}

std::vector<Vec3> phones_at(const Scenario& scenario, int array, int ping, double time) {
  const ReceiverArray& one = array_of(scenario, array);
  std::vector<Vec3> phones;
  if (one.towed) {
    const Track& carrier = carrier_of(scenario, array);
    const auto at = [&](double behind) {
      return on_the_path(carrier, time, behind, one.towed->heading);
    };
    const Vec3 reference = at(mean_behind(*one.towed));
    for (const double behind : one.towed->behind) phones.emplace_back(at(behind) - reference);
    return phones;
  }
  phones = given_phones(one, ping);
  const Vec3 middle = middle_of(one);
  if (!middle.isZero(0.0))
    for (Vec3& phone : phones) phone -= middle;
  return phones;
}

std::vector<Vec3> phones_from(const Carried& point, const Scenario& scenario, int array, int ping,
                              double time) {
  const ReceiverArray& one = array_of(scenario, array);
  std::vector<Vec3> phones =
      one.towed ? phones_at(scenario, array, ping, time) : given_phones(one, ping);
  const Vec3 from = one.towed ? array_at(scenario, array, time).position
                              : Vec3(carrier_of(scenario, array).at(time).position + one.offset);
  const Vec3 aside = from - point.at(time).position;
  if (!aside.isZero(0.0))
    for (Vec3& phone : phones) phone += aside;
  return phones;
}

}  // namespace asdic::detail
