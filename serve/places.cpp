#include "serve/places.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/text.h"
#include "serve/refusal.h"
#include "sonar/scenario/carried.h"

namespace asdic::detail::serve {
namespace {

/// When a track is looked at: its waypoints and, over a sea floor or a surface with a shape, places
/// in between.
std::vector<double> moments(const Scenario& scenario, const Track& track, double from, double to) {
  std::vector<double> times{from, to};
  for (const Waypoint& point : track.waypoints)
    if (point.time > from && point.time < to) times.push_back(point.time);
  const bool shaped =
      scenario.area || scenario.environment.surface.shape || scenario.environment.bottom.shape;
  constexpr int parts = 32;
  if (shaped && track.course_at(from))
    for (int i = 1; i < parts; ++i) times.push_back(std::lerp(from, to, double(i) / parts));
  return times;
}

void check_depth(const Scenario& scenario, const Vec3& place, double time,
                 const std::string& what) {
  // It would stand still there: no straight line leads on.
  if (std::max(std::abs(place.x()), std::abs(place.y())) >= (1.0 - 1e-9) * farthest)
    throw Refusal("scenario",
                  refusal_text(what,
                               "a place " + to_text(std::round(place.head<2>().norm())) +
                                   " m away at " + to_text(time) + " s",
                               "coordinates below " + to_text(farthest) + " m"));
  const OceanOnMap ocean = ocean_on_map(scenario);
  const double top = ocean.surface_depth(place), bottom = ocean.bottom_depth(place);
  if (place.z() > top && place.z() < bottom) return;
  throw Refusal("scenario",
                refusal_text(what, "depth " + to_text(place.z()) + " m at " + to_text(time) + " s",
                             "a depth between the surface (" + to_text(std::round(top)) +
                                 " m) and the bottom (" + to_text(std::round(bottom)) + " m)"));
}

/// "targets", or `targets "rock"` of several: as commands call them.
template <class List>
std::string called(const std::string& kind, const List& list, std::size_t index) {
  return list.size() == 1 ? kind : kind + " " + in_quotes(list[index].name);
}

}  // namespace

void check_places(const Scenario& scenario, int ping, int transmitter, double time) {
  const double end = time + scenario.pings.recording_start + scenario.pings.recording_duration;
  const auto check = [&](const Track& track, const std::string& what, const auto& place_at) {
    for (const double t : moments(scenario, track, time, end))
      check_depth(scenario, place_at(t), t, what);
  };
  const auto check_track = [&](const Track& track, const std::string& what) {
    check(track, what, [&](double t) { return track.at(t).position; });
  };
  for (std::size_t i = 0; i < scenario.transmitters.size(); ++i) {
    const auto platform = static_cast<std::size_t>(scenario.transmitters[i].platform);
    check(scenario.platforms[platform].track, called("platform", scenario.platforms, platform),
          [sender = sender_of(scenario, static_cast<int>(i))](double t) {
            return sender.at(t).position;
          });
  }
  for (std::size_t a = 0; a < scenario.arrays.size(); ++a) {
    const ArrayMotion array(scenario, static_cast<int>(a));
    const std::size_t phones = array.phones(ping, time).size();
    for (std::size_t n = 0; n < phones; ++n)
      check(array.carrier(), called("array", scenario.arrays, a),
            [phone = array.phone(ping, static_cast<int>(n))](double t) {
              return phone.at(t).position;
            });
  }
  const Vec3 source = sender_of(scenario, transmitter).at(time).position;
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const Target& target = scenario.targets[i];
    if (ping < target.first_ping || ping > target.last_ping) continue;
    const std::string what = called("targets", scenario.targets, i);
    check_track(target.track, what);
    const double distance = (target.track.at(time).position - source).norm();
    if (distance < 1.0)  // levels refer to 1 m
      throw Refusal("scenario",
                    refusal_text(what, to_text(distance) + " m", "at least 1 m from the platform"));
  }
  for (std::size_t i = 0; i < scenario.interferers.size(); ++i)
    check_track(scenario.interferers[i].track, called("interferer", scenario.interferers, i));
}

}  // namespace asdic::detail::serve
