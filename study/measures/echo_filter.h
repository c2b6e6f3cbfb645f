#pragma once
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "sonar/ping/ping.h"
#include "study/plan/measure_plan.h"
#include "study/plan/no_value.h"

namespace asdic::detail::study {

/// What the matched filter says of one target.
struct FilterAnswer {
  double present = 0.0;  ///< |y|² over the background at the echo's time; NaN: not known, outside
                         ///< the record or with too few free cells around
  double absent = 0.0;   ///< the same at a time without any echo; NaN: there is none in the record
  double threshold = 0.0, absent_threshold = 0.0;  ///< that the false-alarm probability asks for
};

/// Whether it is over its threshold, 0 or 1; NaN: not known, which is not the same as missed.
[[nodiscard]] inline double over_threshold(double statistic, double threshold) {
  if (std::isnan(statistic)) return no_value;
  return statistic > threshold ? 1.0 : 0.0;
}
[[nodiscard]] inline double over_threshold(const FilterAnswer& answer) {
  return over_threshold(answer.present, answer.threshold);
}

/// Means of |y|² over noise and scatterers, at the times that a target's filter looks at.
struct ExpectedAnswer {
  double present = 0.0, absent = 0.0;
  int draws = 0;                ///< over which it is a mean; 0: it is known
  std::vector<double> cells{};  ///< the same in all cells of the record, where these are counted
};

/// A cell of the record that is free of echoes and of the direct blast.
struct FreeCell {
  double time = 0.0;   ///< at which an echo of that answer would come [s]
  double level = 0.0;  ///< −ln P, P the probability of as high an answer in even Rayleigh noise
};

/// y(τ) = ∫ p₊(t) s₊*(η(t − τ)) dt / ∫|s₊|² dt at the delay τ, Doppler factor η and, of a beam,
/// slowness of the target's strongest path; over its background. That is E|y|² = 2N₀/(n∫|s₊|²dt) of
/// n phones' white noise, the mean of |y|² in the nearest cells that are free of echoes, the same
/// along a trend of their level, or the mean over draws. A target that no path reaches is listened
/// for when the sound would come along a straight line. Source: docs/theory/studies.md, eq. (1)–(3)
/// and (16) \param record  the whole, or the part of it that samples_for_filter() names   \param
/// false_alarm_probability  of one cell, for the thresholds   \param expected  of this target
[[nodiscard]] FilterAnswer filter_answer(const PingSimulator& simulator, const PingRecord& record,
                                         const MatchedFilterPlan& plan, int array, int target,
                                         double false_alarm_probability,
                                         const ExpectedAnswer& expected = {});

/// The samples of the whole record that filter_answer() looks at, of all targets, rounded up to a
/// length that others have. \param record  with its echoes and legs; without samples
[[nodiscard]] SampleRange samples_for_filter(const PingSimulator& simulator,
                                             const PingRecord& record,
                                             const MatchedFilterPlan& plan, int array);

/// All of them: whole cells of 1/B from the target's echo, in the order of time, each compared with
/// its own background as the echo is. \param record  the whole
[[nodiscard]] std::vector<FreeCell> free_cells(const PingSimulator& simulator,
                                               const PingRecord& record,
                                               const MatchedFilterPlan& plan, int array, int target,
                                               const ExpectedAnswer& expected = {});

/// What the simulation itself expects at the times that filter_answer() looks at: each draw is the
/// same sea and noise with other random numbers and without targets, heard by the same filters.
/// \param record  of the ping itself   \param draw  makes the k-th, or that part of it   \param
/// cells  of the whole record as well
[[nodiscard]] std::vector<ExpectedAnswer> expected_answers(
    const PingSimulator& simulator, const PingRecord& record, const MatchedFilterPlan& plan,
    int array, bool cells, const std::function<PingRecord(int k, const SampleRange& part)>& draw);

/// The same without draws (expected_power.h). \param cells  of the whole record as well
/// \throws InputError where it cannot be summed
[[nodiscard]] std::vector<ExpectedAnswer> summed_answers(const PingSimulator& simulator,
                                                         const PingRecord& record,
                                                         const MatchedFilterPlan& plan, int array,
                                                         bool cells);

}  // namespace asdic::detail::study
