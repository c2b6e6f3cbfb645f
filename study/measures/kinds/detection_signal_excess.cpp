#include "study/measures/kinds/detection_signal_excess.h"

#include <cmath>

#include "study/measures/echo_filter.h"
#include "study/measures/signal_excess.h"

namespace asdic::detail::study {
namespace {

/// The receiver whose threshold [measure.detection] sets, for one cell of an echo.
/// \param ping  measured by a plan that has a detection
ListeningReceiver receiver_of(const MeasuredPing& ping, int target) {
  const MeasurePlan& plan = ping.plan;
  ListeningReceiver receiver{.array = plan.array,
                             .false_alarm_probability = plan.detection->false_alarm_probability};
  if (plan.detection->by == DetectionPlan::By::receiver) {
    receiver.cells = 2.0 * plan.receiver.detector.normaliser.reference_cells;
    return receiver;
  }
  receiver.phone = plan.matched_filter.phone;
  receiver.cells = plan.matched_filter.estimated_from();
  const int cells = cells_of_echo(*ping.simulator, *ping.record, plan.array, target);
  if (cells > 1)  // all of them together have the set probability
    receiver.false_alarm_probability =
        -std::expm1(std::log1p(-receiver.false_alarm_probability) / cells);
  return receiver;
}

}  // namespace

void DetectionSignalExcess::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  double excess = no_value;
  const int number = static_cast<int>(target);
  if (ping)
    excess = detection_signal_excess_db(*ping.simulator, *ping.record, receiver_of(ping, number),
                                        number);
  to.add("detection_signal_excess_db", "dB",
         "echo over what the receiver detects half of the time; −∞: no path", excess);
}

}  // namespace asdic::detail::study
