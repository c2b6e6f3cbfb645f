#pragma once
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "processing/array_shape.h"
#include "processing/detection.h"
#include "sonar/scenario/track.h"

namespace asdic::detail {

/// In the place of a target: the transmitter's own sound, straight to the array.
inline constexpr int direct_sound = -2;
/// The same of what a continuous record holds of other pings.
inline constexpr int another_ping = -3;

/// One path pair of a target, as the simulation knows it.
struct TrueEcho {
  int target = 0;               ///< index, direct_sound or another_ping
  double time = 0.0;            ///< of its leading edge [s]
  double struck = 0.0;          ///< when that met the target [s]
  double doppler = 1.0;         ///< factor
  double level_db = 0.0;        ///< [dB re 1 µPa]
  Vec3 travel = Vec3::UnitY();  ///< direction at the array, unit vector
  /// Level that it must have to be detected among the noise and reverberation of its own cell
  /// (DetectorResult::thresholds_db) [dB re 1 µPa]; −∞: not known, any will do
  double threshold_db = -infinity;
};

/// A target during one ping.
struct TrueTarget {
  int target = 0;
  std::string name{};
  bool present = false;
  Vec3 position = Vec3::Zero();  ///< when the sound struck it [m]
};

/// How near a detection must be to be the echo's.
struct Resolution {
  double time = 0.0;               ///< a cell [s]
  double doppler = 0.0;            ///< factors' difference
  double delay_per_doppler = 0.0;  ///< a sweep's time is right up to this times an error of η [s]
  /// Of pulses so long that a path curves meanwhile: that changes a sweep's rate, which the filters
  /// take for a Doppler factor without the delay that belongs to it. The time is right somewhere
  /// between with and without the ridge.
  bool curved = false;
  double direction = 0.0;  ///< cosine's (line) or angle's difference: a beam's width
};

/// What became of one target in one ping.
struct TargetScore {
  int target = 0;
  bool present = false;
  bool detectable = false;  ///< an echo of it, over the threshold, is in the time searched
  bool hit = false;
  int detection = -1;           ///< the loudest that is its
  double position_error = 0.0;  ///< horizontal, of the better of two sides; NaN without a place [m]
  double range_error = 0.0;     ///< found − true, from the array; NaN [m]
  double bearing_error = 0.0;   ///< found − true; NaN [rad]
  Vec2 error{std::nan(""), std::nan("")};       ///< found − true, of that side; NaN [m]
  Vec2 from_array{std::nan(""), std::nan("")};  ///< where it was, of a detected one; NaN [m]
};

struct PingScore {
  std::vector<TargetScore> targets;
  std::vector<int>
      owner;  ///< [detections] target, direct_sound, another_ping, or −1: a false alarm
  int hits = 0, misses = 0, false_alarms = 0;
};

/// Whose detections these are. A detection is a target's if it is within a cell of one of its path
/// pairs in time, Doppler factor and direction (of pairs closer than a cell it may lie anywhere
/// between) that can be so loud: whose target's pairs within a cell, all in phase, are no more than
/// 10 dB below it or below the threshold. It belongs to the one whose echo is loudest there. A
/// target is detectable if its pairs within a cell have together, as powers, the level that they
/// need. Ranges and bearings are those from where the array was when it received the detection.
/// \param array  from when the ping was sent on [m]   \param first, last  time that is searched
/// [s]
[[nodiscard]] PingScore score_detections(std::span<const Detection> detections,
                                         std::span<const TrueEcho> echoes,
                                         std::span<const TrueTarget> targets,
                                         const ArrayShape& shape, const Track& array,
                                         const Resolution& resolution, double first, double last);

}  // namespace asdic::detail
