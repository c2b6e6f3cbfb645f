#pragma once
#include <span>
#include <vector>

#include "study/plan/measure_plan.h"

namespace asdic::detail::study {

/// One ping of a run: whether it detects each target, and how far that is.
struct RunPing {
  int ping = 1;                    ///< of the scenario, counted from 1
  double time = 0.0;               ///< of its start, after that of the run's first ping [s]
  std::vector<double> detected{};  ///< [targets] 0 or 1; NaN: not known
  std::vector<double> range{};     ///< [targets] horizontal, from the transmitter [m]
};

/// What a run comes to for one target. A run with a ping that is not known is not known.
struct RunAnswer {
  bool known = false;
  int detections = 0;  ///< pings with one
  int first = -1;      ///< which ping has the first one, from 0; −1: none
  int initiated = -1;  ///< with which ping the track begins, from 0; −1: it does not
};

/// \param detected  [pings] 0, 1, or NaN
[[nodiscard]] RunAnswer run_answer(std::span<const double> detected, const PingRunPlan& plan);

}  // namespace asdic::detail::study
