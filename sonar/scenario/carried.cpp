// Where transmitters, an array's phones and their middle are, and how they move.
#include "sonar/scenario/carried.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry.h"
#include "core/propagation_memory.h"

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
Vec3 middle_of_given(const ReceiverArray& array) {
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

/// As given, of one that is not towed.
const std::vector<Vec3>& given_phones(const ReceiverArray& array, int ping) {
  if (array.shapes.empty()) return array.phones;
  return array.shapes[static_cast<std::size_t>(ping - 1) % array.shapes.size()];
}

}  // namespace

void add_to(ExactKey& key, const Carried& carried) {
  // Every member by name: one more does not compile until it is here.
  const auto& [track, offset] = carried;
  key.add_all(track, offset);
}

Carried sender_of(const Scenario& scenario, int transmitter) {
  const Transmitter& one = scenario.transmitters[static_cast<std::size_t>(transmitter)];
  return {scenario.platforms[static_cast<std::size_t>(one.platform)].track, one.offset};
}

ArrayMotion::ArrayMotion(const Scenario& scenario, int array)
    : array_(&scenario.arrays[static_cast<std::size_t>(array)]),
      carrier_(&scenario.platforms[static_cast<std::size_t>(array_->platform)].track) {
  if (array_->towed)
    reference_ = {trailing(*carrier_, mean_behind(*array_->towed), array_->towed->heading),
                  array_->offset};
  else
    reference_ = {*carrier_, array_->offset + middle_of_given(*array_)};
}

std::vector<ArrayMotion> array_motions(const Scenario& scenario) {
  std::vector<ArrayMotion> all;
  for (int a = 0; a < static_cast<int>(scenario.arrays.size()); ++a) all.emplace_back(scenario, a);
  return all;
}

Carried ArrayMotion::middle_of(int ping, PhoneRange phones) const {
  if (array_->towed)
    return {trailing(*carrier_, mean_behind(*array_->towed, phones), array_->towed->heading),
            array_->offset};
  const std::vector<Vec3>& given = given_phones(*array_, ping);
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < phones.count; ++n) sum += given[phones.first + n];
  return {*carrier_, array_->offset + sum / static_cast<double>(phones.count)};
}

Carried ArrayMotion::phone(int ping, int phone) const {
  return middle_of(ping, {static_cast<std::size_t>(phone), 1});
}

bool ArrayMotion::deforms() const noexcept {
  return array_->towed && carrier_->waypoints.size() > 2;
}

std::vector<Vec3> ArrayMotion::phones(int ping, double time) const {
  std::vector<Vec3> phones;
  if (array_->towed) {
    const auto at = [&](double behind) {
      return on_the_path(*carrier_, time, behind, array_->towed->heading);
    };
    const Vec3 reference = at(mean_behind(*array_->towed));
    for (const double behind : array_->towed->behind) phones.emplace_back(at(behind) - reference);
    return phones;
  }
  phones = given_phones(*array_, ping);
  const Vec3 middle = middle_of_given(*array_);
  if (!middle.isZero(0.0))
    for (Vec3& phone : phones) phone -= middle;
  return phones;
}

std::vector<Vec3> ArrayMotion::phones_from(const Carried& point, int ping, double time) const {
  std::vector<Vec3> found = array_->towed ? phones(ping, time) : given_phones(*array_, ping);
  const Vec3 from =
      array_->towed ? at(time).position : Vec3(carrier_->at(time).position + array_->offset);
  const Vec3 aside = from - point.at(time).position;
  if (!aside.isZero(0.0))
    for (Vec3& phone : found) phone += aside;
  return found;
}

// What is asked once.

Kinematics transmitter_at(const Scenario& scenario, int transmitter, double time) {
  return sender_of(scenario, transmitter).at(time);
}

Kinematics array_at(const Scenario& scenario, int array, double time) {
  return ArrayMotion(scenario, array).at(time);
}

std::vector<Vec3> phones_at(const Scenario& scenario, int array, int ping, double time) {
  return ArrayMotion(scenario, array).phones(ping, time);
}

}  // namespace asdic::detail
