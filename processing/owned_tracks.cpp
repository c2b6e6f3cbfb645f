#include "processing/owned_tracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/geometry.h"

namespace asdic::detail {
namespace {

/// The target that most of a track's detections are of.
int owner_of(const ContactTrack& track, std::span<const TrackedPing> pings) {
  std::map<int, int> votes;
  for (const TrackPoint& p : track.points)
    if (p.detection >= 0)
      ++votes[pings[static_cast<std::size_t>(p.ping)].owner[static_cast<std::size_t>(p.detection)]];
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == votes.end() ? -1 : most->first;
}

/// Which point has so many hits before it and with it that the track is believed.
std::size_t believed_at(const ContactTrack& track, int start_hits) {
  int hits = 0;
  for (std::size_t i = 0; i < track.points.size(); ++i)
    if (track.points[i].detection >= 0 && ++hits >= start_hits) return i;
  return track.points.size() - 1;
}

double error_of(const TrackPoint& p, bool bearings, const TrackedPing& ping, const Track& target) {
  const Vec3 truth = target.at(p.time).position;
  if (bearings) return (p.position - truth.head<2>()).norm();
  // A range is from where the array received it; a track that coasts, from where it would have.
  const double received = p.detection >= 0 ? ping.received[static_cast<std::size_t>(p.detection)]
                                           : 2.0 * (p.time - ping.time);
  return std::abs(p.position.y() - separation(ping.array.at(received).position, truth).range);
}

}  // namespace

TrackedPing tracked_ping(const PingProcessor& processor, const ProcessedArray& processed,
                         double ping_time, std::vector<int> owner) {
  TrackedPing made{.time = ping_time, .array = processed.places.array, .owner = std::move(owner)};
  for (const Detection& d : processed.result.detections) {
    made.received.push_back(d.time);
    made.two_sides |= d.locations.size() > 1;
    made.bearings &= d.locations.empty() || !std::isnan(d.locations[0].bearing);
  }
  for (int side = 0; side < (made.two_sides ? 2 : 1); ++side) {
    std::vector<Contact>& contacts = made.contacts[static_cast<std::size_t>(side)];
    contacts = processor.contacts(processed, ping_time, side);
    std::erase_if(contacts, [&](const Contact& c) {
      const int of = made.owner[static_cast<std::size_t>(c.detection)];
      return of == direct_sound || of == another_ping;
    });
  }
  return made;
}

std::vector<OwnedTrack> owned_tracks(std::span<const TrackedPing> pings, const Scenario& scenario,
                                     const TrackerSettings& settings) {
  const auto any_two = [](const TrackedPing& ping) { return ping.two_sides; };
  const bool sides = std::any_of(pings.begin(), pings.end(), any_two),
             bearings = std::all_of(pings.begin(), pings.end(),
                                    [](const TrackedPing&ping) { return ping.bearings; });
  std::vector<OwnedTrack> made;
  for (int side = 0; side < (sides ? 2 : 1); ++side) {
    std::vector<std::vector<Contact>> contacts;
    std::vector<double> times;
    for (const TrackedPing& ping : pings) {
      contacts.push_back(ping.contacts[static_cast<std::size_t>(side)]);
      times.push_back(ping.time);
    }
    for (ContactTrack& track : track_contacts(contacts, times, settings)) {
      OwnedTrack one{.track = std::move(track), .side = side};
      one.target = owner_of(one.track, pings);
      one.believed = believed_at(one.track, settings.start_hits);
      for (const TrackPoint& p : one.track.points)
        one.error.push_back(
            one.target < 0
                ? std::numeric_limits<double>::quiet_NaN()
                : error_of(p, bearings, pings[static_cast<std::size_t>(p.ping)],
                           scenario.targets[static_cast<std::size_t>(one.target)].track));
      made.push_back(std::move(one));
    }
  }
  return made;
}

}  // namespace asdic::detail
