#include "study/measures/kinds/of_the_receiver.h"

namespace asdic::detail::study {

void DetectionByReceiver::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  const ReceiverAnswer& answer = ping.receiver.targets[target];
  to.add("detected", "1", "a detection of the receiver is the target's", answer.hit ? 1.0 : 0.0);
  to.add("detection_snr_db", "dB", "of the loudest detection that is the target's", answer.snr_db);
}

void LocalisationError::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  const ReceiverAnswer& answer = ping.receiver.targets[target];
  to.add("position_error", "m", "horizontal, of the better of two sides", answer.position_error);
  to.add("range_error", "m", "found less actual, from the array", answer.range_error);
  to.add("bearing_error_deg", "degrees", "found less actual", degrees(answer.bearing_error));
}

void LocalisationEllipse::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  const ReceiverAnswer& answer = ping.receiver.targets[target];
  const Vec2 sight = answer.from_array.normalized();  // to the target
  const Vec2 right(sight.y(), -sight.x());
  to.add("target_east", "m", "of a detected target, from the array", answer.from_array.x());
  to.add("target_north", "m", "of a detected target, from the array", answer.from_array.y());
  to.add("east_error", "m", "found less actual, of the better of two sides", answer.error.x());
  to.add("north_error", "m", "found less actual, of the better of two sides", answer.error.y());
  to.add("away_error", "m", "the same along the line of sight, away from the array",
         answer.error.dot(sight));
  to.add("across_error", "m", "the same across the line of sight, to the right",
         answer.error.dot(right));
}

void FalseAlarms::of_ping(const MeasuredPing& ping, Collector& to) {
  to.add("false_alarms", "1", "detections that are no target's", ping.receiver.false_alarms);
  to.add("false_alarms_of_noise", "1", "as many of them as even noise makes at most",
         ping.receiver.of_noise);
}

}  // namespace asdic::detail::study
