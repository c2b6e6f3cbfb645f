#pragma once
#include <vector>

#include "processing/owned_tracks.h"
#include "sonar/ping/ping.h"
#include "study/plan/measure_plan.h"

namespace asdic::detail::study {

/// What the whole receiver makes of one target.
struct ReceiverAnswer {
  bool hit = false;                ///< a detection is the target's
  double snr_db = 0.0;             ///< of the loudest of those; NaN
  double position_error = 0.0;     ///< horizontal; NaN without a place [m]
  double range_error = 0.0;        ///< found − true; NaN [m]
  double bearing_error = 0.0;      ///< found − true; NaN [rad]
  Vec2 error = Vec2::Zero();       ///< found − true, east and north; NaN without a place [m]
  Vec2 from_array = Vec2::Zero();  ///< where the target was; NaN where it is missed [m]
};
struct ReceiverAnswers {
  std::vector<ReceiverAnswer> targets;
  int false_alarms = 0;               ///< detections that are nobody's
  double of_noise = 0.0;              ///< largest number of false alarms by even noise
  std::vector<Detection> detections;  ///< all of them, sorted by time
  TrackedPing places{};               ///< of all of them, and whose they are, for a tracker
};

/// What an array of the scenario recorded of the ping, as the receiver takes it.
[[nodiscard]] ArrayRecording array_recording(const Scenario& scenario, const PingRecord& record,
                                             int array);

/// `asdic process` for one ping of one array, in memory: band, beams, matched filters, detections,
/// places, and whose they are. Source: docs/theory/processing.md   \throws InputError
[[nodiscard]] ReceiverAnswers receiver_answers(const PingSimulator& simulator,
                                               const PingRecord& record,
                                               const ProcessingSettings& settings, int array);

}  // namespace asdic::detail::study
