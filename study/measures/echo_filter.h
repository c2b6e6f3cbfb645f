#pragma once
#include <optional>

#include "sonar/ping/ping.h"
#include "study/plan/measure_plan.h"

namespace asdic::detail::study {

/// What the matched filter says of one target.
struct FilterAnswer {
  double present = 0.0;  ///< |y|² over the background at the echo's time; NaN: not known, outside
                         ///< the record or with too few free cells around
  double absent = 0.0;   ///< the same at a time without any echo; NaN: there is none in the record
  double threshold = 0.0, absent_threshold = 0.0;  ///< that the false-alarm probability asks for
};

/// y(τ) = ∫ p₊(t) s₊*(η(t − τ)) dt / ∫|s₊|² dt at the delay τ, Doppler factor η and, of a beam,
/// slowness of the target's strongest path; over E|y|² = 2N₀/(n∫|s₊|²dt) of n phones' white noise,
/// or over the mean of |y|² in the nearest cells that are free of echoes. A target that no path
/// reaches is listened for when the sound would come along a straight line. Source:
/// docs/theory/studies.md, eq. (1)–(3) \param record  the whole, or the part of it that
/// samples_for_filter() names   \param false_alarm_probability  of one cell, for the thresholds
[[nodiscard]] FilterAnswer filter_answer(const PingSimulator& simulator, const PingRecord& record,
                                         const MatchedFilterPlan& plan, int array, int target,
                                         double false_alarm_probability);

/// The samples of the whole record that filter_answer() looks at, of all targets, rounded up to a
/// length that others have. \param record  with its echoes and legs; without samples
[[nodiscard]] SampleRange samples_for_filter(const PingSimulator& simulator,
                                             const PingRecord& record,
                                             const MatchedFilterPlan& plan, int array);

}  // namespace asdic::detail::study
