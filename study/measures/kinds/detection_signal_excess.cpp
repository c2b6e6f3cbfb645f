#include "study/measures/kinds/detection_signal_excess.h"

#include "study/measures/signal_excess.h"

namespace asdic::detail::study {
namespace {

/// The receiver whose threshold [measure.detection] sets. \param plan  with a detection
ListeningReceiver receiver_of(const MeasurePlan& plan) {
  ListeningReceiver receiver{.array = plan.array,
                             .false_alarm_probability = plan.detection->false_alarm_probability};
  if (plan.detection->by == DetectionPlan::By::receiver) {
    receiver.cells = 2.0 * plan.receiver.detector.normaliser.reference_cells;
    return receiver;
  }
  receiver.phone = plan.matched_filter.phone;
  receiver.cells = plan.matched_filter.estimated_from();
  return receiver;
}

}  // namespace

void DetectionSignalExcess::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  double excess = no_value;
  if (ping)
    excess = detection_signal_excess_db(*ping.simulator, *ping.record, receiver_of(ping.plan),
                                        static_cast<int>(target));
  to.add("detection_signal_excess_db", "dB",
         "echo over what the receiver detects half of the time; −∞: no path", excess);
}

}  // namespace asdic::detail::study
