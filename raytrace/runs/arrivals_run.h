#pragma once
#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {

/// What a run keeps of the paths it could find.
struct PathSelection {
  /// A path is followed until reflections have left this much of it: −60 dB. (BELLHOP drops a ray
  /// at 0.005, −46 dB; so every path it can find is here.)
  double faintest_reflection = 1e-3;
  /// Paths this much weaker than the strongest at their receiver are left out [dB].
  double weakest_db = 60.0;
};

/// Arrivals of a case (Task::arrivals) for each of its sources: exact eigenrays, one row a path,
/// with the source's pattern and kind in their amplitudes. A number of beams in the case means
/// nothing to them, its fan's limits do. The same bits for any number of threads.
/// \throws InputError  a source outside the water, no receivers, a fan without width
/// \throws Interrupted when `progress` says so
[[nodiscard]] PropagationResult run_arrivals(const PropagationCase& run_case,
                                             const Progress& progress = {},
                                             const PathSelection& selection = {});

/// The same as drawn paths, and with the arrivals as well (Task::eigenrays,
/// Task::eigenrays_and_arrivals).
[[nodiscard]] PropagationResult run_eigenrays(const PropagationCase& run_case,
                                              const Progress& progress = {},
                                              const PathSelection& selection = {});

/// The receivers of a grid in the order of results.
[[nodiscard]] std::vector<ReceiverPoint> points_of(const ReceiverGrid& grid);

}  // namespace asdic::detail
