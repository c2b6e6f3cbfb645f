#pragma once
#include <span>
#include <vector>

#include "processing/owned_tracks.h"
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

/// The tracker's track of one target: of several that which is believed first.
struct TargetTrack {
  int believed = -1;   ///< with which ping, from 0; −1: there is none
  double error = 0.0;  ///< of its last place, horizontal (or in range); NaN without a track [m]
};

/// What a tracker makes of a run.
struct TrackedRun {
  std::vector<TargetTrack> targets{};
  int false_tracks = 0;  ///< believed ones of which most detections are nobody's
};

/// `asdic process`'s tracks, and whose they are. \param pings  of the run, in order
[[nodiscard]] TrackedRun tracked_run(std::span<const TrackedPing> pings, const Scenario& scenario,
                                     const TrackerSettings& settings);

/// What a realisation's run of pings comes to.
struct PingRun {
  std::vector<RunPing> pings{};
  TrackedRun tracks{};  ///< if the plan has a tracker
};

}  // namespace asdic::detail::study
