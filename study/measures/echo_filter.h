#pragma once
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sonar/ping/ping.h"
#include "study/plan/measure_plan.h"
#include "study/plan/no_value.h"

namespace asdic::detail::study {

/// Statistics of a target's matched filter. Each is that of the highest of the echo's cells over
/// its background, given as the ratio that is equally improbable in a single cell.
struct FilterAnswer {
  double present = 0.0;  ///< in the echo's cells; NaN: not known
  double absent = 0.0;   ///< in the same cells, at a time without an echo; NaN: none in the record
  double threshold = 0.0, absent_threshold = 0.0;  ///< that the false-alarm probability asks for
  std::string unknown{};                           ///< reason why `present` is not known
};

/// Whether it is over its threshold, 0 or 1; NaN: not known, which is not the same as missed.
[[nodiscard]] inline double over_threshold(double statistic, double threshold) {
  if (std::isnan(statistic)) return no_value;
  return statistic > threshold ? 1.0 : 0.0;
}
[[nodiscard]] inline double over_threshold(const FilterAnswer& answer) {
  return over_threshold(answer.present, answer.threshold);
}

/// Means of |y|² over noise and scatterers, in the cells that a target's filter looks at.
struct ExpectedAnswer {
  std::vector<double> present{}, absent{};
  std::vector<double> cells{};  ///< the same in all cells of the record, where these are counted
};

/// A cell of the record that is free of echoes and of the direct blast.
struct FreeCell {
  double time = 0.0;   ///< at which an echo of that answer would come [s]
  double level = 0.0;  ///< −ln P, P the probability of as high an answer in even Rayleigh noise
};

/// y(τ) = ∫ p₊(t) s₊*(η(t − τ)) dt / ∫|s₊|² dt at the Doppler factor η and, of a beam, the slowness
/// of the target's strongest path, in all cells of 1/B in which it answers to the target's paths
/// with a tenth of the loudest one's power; over its background. That is E|y|² = 2N₀/(n∫|s₊|²dt) of
/// n phones' white noise, the mean of |y|² in the nearest cells that are free of echoes, the same
/// along a trend of their level, or the mean over draws. A target that no path reaches is listened
/// for when the sound would come along a straight line. Source: docs/theory/studies.md, eq.
/// (1)–(3), (16) and (27) \param record  the whole, or the part of it that samples_for_filter()
/// names \param false_alarm_probability  of all cells of the echo together, for the thresholds
/// \param expected  of this target
[[nodiscard]] FilterAnswer filter_answer(const PingSimulator& simulator, const PingRecord& record,
                                         const MatchedFilterPlan& plan, int array, int target,
                                         double false_alarm_probability,
                                         const ExpectedAnswer& expected = {});

/// Number of cells in which filter_answer() looks for a target's echo.
[[nodiscard]] int cells_of_echo(const PingSimulator& simulator, const PingRecord& record, int array,
                                int target);

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
