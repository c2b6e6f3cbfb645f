#include "study/measures/ping_run.h"

#include <algorithm>
#include <cmath>

#include "study/plan/no_value.h"

namespace asdic::detail::study {

RunAnswer run_answer(std::span<const double> detected, const PingRunPlan& plan) {
  RunAnswer answer{.known = std::all_of(detected.begin(), detected.end(),
                                        [](double one) { return std::isfinite(one); })};
  if (!answer.known) return answer;
  int in_window = 0;  // hits of the last plan.within pings
  for (int k = 0; k < static_cast<int>(detected.size()); ++k) {
    const auto hit = [&](int ping) { return detected[static_cast<std::size_t>(ping)] > 0.0; };
    if (hit(k)) {
      ++answer.detections;
      ++in_window;
      if (answer.first < 0) answer.first = k;
    }
    if (k >= plan.within && hit(k - plan.within)) --in_window;
    if (plan.initiates() && answer.initiated < 0 && in_window >= plan.hits) answer.initiated = k;
  }
  return answer;
}

TrackedRun tracked_run(std::span<const TrackedPing> pings, const Scenario& scenario,
                       const TrackerSettings& settings) {
  TrackedRun made{.targets = {scenario.targets.size(), {.error = no_value}}};
  for (const OwnedTrack& one : owned_tracks(pings, scenario, settings)) {
    if (one.target < 0) {
      ++made.false_tracks;
      continue;
    }
    TargetTrack& of = made.targets[static_cast<std::size_t>(one.target)];
    const int believed = one.track.points[one.believed].ping;
    const bool first = of.believed < 0 || believed < of.believed,
               nearer = believed == of.believed && one.error.back() < of.error;
    if (first || nearer) of = {.believed = believed, .error = one.error.back()};
  }
  return made;
}

}  // namespace asdic::detail::study
