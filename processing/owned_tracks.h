#pragma once
#include <array>
#include <span>
#include <vector>

#include "processing/ping_processor.h"
#include "processing/scoring.h"
#include "processing/tracker.h"

namespace asdic::detail {

/// One ping of one array, as tracks are made of it.
struct TrackedPing {
  double time = 0.0;  ///< when it was sent [s]
  Track array{};      ///< where the array's reference point is, from then on [m]
  /// [sides] of detections: of echoes and of nobody's. Sound that comes straight, or of another
  /// ping, is left out. The second side is empty where left and right are told.
  std::array<std::vector<Contact>, 2> contacts{};
  std::vector<double> received{};  ///< [detections] after the ping's start [s]
  std::vector<int> owner{};        ///< [detections] as score_detections() says
  bool two_sides = false;          ///< a detection has two places
  bool bearings = true;            ///< all places have bearings
};

/// \param owner  [detections] of the ping
[[nodiscard]] TrackedPing tracked_ping(const PingProcessor& processor,
                                       const ProcessedArray& processed, double ping_time,
                                       std::vector<int> owner);

/// A track, and whose it is.
struct OwnedTrack {
  ContactTrack track;
  int side = 0;
  int target = -1;            ///< that most of its detections are of; −1: nobody's
  std::size_t believed = 0;   ///< with which of its points the tracker took it for one
  std::vector<double> error;  ///< [points] from that target, horizontal (or in range); NaN [m]
};

/// The tracks of each side, first side first. \param pings  of one array, in order of time
[[nodiscard]] std::vector<OwnedTrack> owned_tracks(std::span<const TrackedPing> pings,
                                                   const Scenario& scenario,
                                                   const TrackerSettings& settings);

}  // namespace asdic::detail
