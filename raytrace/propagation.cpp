#include "raytrace/propagation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "raytrace/cases/memory.h"
#include "raytrace/runs/arrivals_run.h"
#include "raytrace/runs/field_run.h"
#include "raytrace/runs/rays_run.h"
#include "raytrace/runs/volume_run.h"

namespace asdic::detail {
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
                "nothing reaches a receiver: all lie outside the box in which rays are traced "
                "(receivers %g to %g km away, %g to %g m deep; box %g km, %g m)",
                *least / 1000.0, *most / 1000.0, *shallowest, *deepest, run_case.box_range / 1000.0,
                run_case.box_depth);
  return text;
}

/// How many receivers lie outside of the water, where no field is computed; "" where none does.
std::string outside_text(const PropagationCase& run_case) {
  constexpr double on_boundary = 1e-3;  // [m]
  const Environment ocean = plane_of(run_case);
  const ReceiverGrid& grid = run_case.receivers;
  std::size_t below = 0, above = 0;
  for (std::size_t j = 0; j < grid.ranges.size(); ++j) {
    const auto first = grid.depths.begin() + static_cast<std::ptrdiff_t>(grid.irregular ? j : 0);
    const auto last = grid.irregular ? first + 1 : grid.depths.end();
    const double floor = ocean.bottom.depth_at(grid.ranges[j]) + on_boundary,
                 surface = ocean.surface.depth_at(grid.ranges[j]) - on_boundary;
    below += static_cast<std::size_t>(last - std::upper_bound(first, last, floor));
    above += static_cast<std::size_t>(std::lower_bound(first, last, surface) - first);
  }
  if (below + above == 0) return "";
  char text[200];
  std::snprintf(
      text, sizeof text,
      "of %zu receivers %zu lie below the bottom and %zu above the surface, where no field "
      "is computed: they have nothing, or the tails of beams in the water",
      grid.size(), below, above);
  return text;
}

PropagationResult run_task(const PropagationCase& run_case, const Progress& progress) {
  if (run_case.dimension == 3) return run_volume(run_case, progress);
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
  if (run_case.dimension == 2 && run_case.off_transect != 0.0) {
    PropagationCase plane = run_case;
    plane.environment = plane_of(run_case);
    plane.off_transect = 0.0;
    plane.on_area.reset();
    return run(plane, progress, budget);
  }
  if (run_case.dimension == 3 && !run_case.on_area &&
      is_layered(run_case.environment)) {  // nothing turns rays
    PropagationCase plane = run_case;
    plane.dimension = 2;
    return run(plane, progress, budget);
  }
  static_cast<void>(run_memory(run_case, budget));
  PropagationResult result = run_task(run_case, progress);
  if (run_case.task != Task::rays && all_beyond_box(run_case))
    result.notes.push_back(beyond_box_text(run_case));
  if (run_case.task != Task::rays)
    if (std::string outside = outside_text(run_case); !outside.empty())
      result.notes.push_back(std::move(outside));
  return result;
}

}  // namespace asdic::detail
