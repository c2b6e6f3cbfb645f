#include "study/measures/kinds/matched_filter.h"

#include "study/measures/echo_filter.h"

namespace asdic::detail::study {

void MatchedFilterAnswer::of_target(const MeasuredPing& ping, std::size_t target, Collector& to) {
  const MeasurePlan& plan = ping.plan;
  FilterAnswer answer;
  if (ping)
    answer = filter_answer(*ping.simulator, *ping.record, plan.matched_filter, plan.array,
                           static_cast<int>(target), plan.false_alarm_probability(),
                           ping.expected.empty() ? ExpectedAnswer{} : ping.expected[target]);
  to.explain(answer.unknown);
  if (plan.detection && plan.detection->by == DetectionPlan::By::matched_filter) {
    to.add("detected", "1", "matched filter over its threshold in the echo; NaN: not known",
           over_threshold(answer));
    to.add("false_alarm", "1", "matched filter over its threshold where there is no echo",
           over_threshold(answer.absent, answer.absent_threshold));
  }
  to.add("snr_matched_db", "dB", "matched filter over its background in the echo",
         db_from_power(answer.present));
  to.add("snr_absent_db", "dB", "matched filter over its background where there is no echo",
         db_from_power(answer.absent));
}

}  // namespace asdic::detail::study
