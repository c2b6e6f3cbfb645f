#include "raytrace/propagation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "raytrace/beams/field_run.h"
#include "raytrace/runs/arrivals_run.h"
#include "raytrace/runs/memory.h"
#include "raytrace/runs/rays_run.h"

namespace asdic {
namespace {

/// Every receiver lies farther away, or deeper, than rays go: a unit slip, most likely.
bool all_beyond_box(const PropagationCase& run_case) {
  const ReceiverGrid& receivers = run_case.receivers;
  const auto beyond = [](const std::vector<double>& places, double box, bool either_side) {
    return box > 0.0 && !places.empty() && std::all_of(places.begin(), places.end(), [&](double x) {
             return (either_side ? std::abs(x) : x) > box;
           });
  };
  return beyond(receivers.ranges, run_case.box_range, true) ||
         beyond(receivers.depths, run_case.box_depth, false);
}

std::string beyond_box_text(const PropagationCase& run_case) {
  const auto [least, most] =
      std::minmax_element(run_case.receivers.ranges.begin(), run_case.receivers.ranges.end());
  const auto [shallowest, deepest] =
      std::minmax_element(run_case.receivers.depths.begin(), run_case.receivers.depths.end());
  char text[256];
  std::snprintf(text, sizeof text,
                "no receiver hears anything: all lie outside the box in which rays are traced "
                "(receivers %g to %g km away, %g to %g m deep; box %g km, %g m)",
                *least / 1000.0, *most / 1000.0, *shallowest, *deepest, run_case.box_range / 1000.0,
                run_case.box_depth);
  return text;
}

PropagationResult run_task(const PropagationCase& run_case, const Progress& progress) {
  switch (run_case.task) {
    case Task::rays:
      return run_rays(run_case, progress);
    case Task::arrivals:
      return run_arrivals(run_case, progress);
    case Task::eigenrays:
    case Task::eigenrays_and_arrivals:
      return run_eigenrays(run_case, progress);
    case Task::field:
      break;
  }
  return run_field(run_case, progress);
}

}  // namespace

PropagationResult run(const PropagationCase& run_case, const Progress& progress,
                      const MemoryBudget& budget) {
  static_cast<void>(run_memory(run_case, budget));
  PropagationResult result = run_task(run_case, progress);
  if (run_case.task != Task::rays && all_beyond_box(run_case))
    result.notes.push_back(beyond_box_text(run_case));
  return result;
}

}  // namespace asdic
