#include "raytrace/cases/memory.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "raytrace/cases/ray_path.h"
#include "raytrace/ocean/arrivals.h"

namespace asdic::detail {
namespace {

constexpr double points_of_a_ray = 100.0;
constexpr double paths_to_a_receiver = 4.0, bounces_of_a_path = 8.0;
constexpr int usual_rays = 50;
/// Of a receiver: the field of one source as it was and as it is, with every second beam and with
/// its error bound; sums in two parts; and of all sources, what is written and looked through.
/// Twice that is what two million receivers were seen to take.
constexpr double a_cell = 2.0 * (4.0 * 16.0 + 2.0 * 24.0), a_cell_of_all = 2.0 * (8.0 + 16.0);

MemoryNeed rays_need(const PropagationCase& run_case) {
  const BeamSettings& beams = run_case.beams;
  const double rays = !beams.elevations.empty() ? static_cast<double>(beams.elevations.size())
                                                : std::max(beams.count, usual_rays);
  const double all = rays * static_cast<double>(run_case.source_depths.size());
  return {.where = "beams.count",
          .what = std::to_string(std::llround(all)) + " rays",
          .bytes = all * (sizeof(RayPath) + points_of_a_ray * sizeof(RayPoint)),
          .remedy = "fewer rays or sources"};
}

MemoryNeed receivers_need(const PropagationCase& run_case) {
  const double sources = static_cast<double>(run_case.source_depths.size());
  const double cells = static_cast<double>(run_case.receivers.size());
  const bool field = run_case.task == Task::field;
  const double paths = paths_to_a_receiver * (sizeof(Arrival) + bounces_of_a_path * sizeof(Bounce));
  return {.where = "receivers",
          .what = std::to_string(std::llround(cells)) + " receivers of " +
                  std::to_string(run_case.source_depths.size()) +
                  (run_case.source_depths.size() == 1 ? " source" : " sources"),
          .bytes = field ? cells * (a_cell + sources * a_cell_of_all) : cells * sources * paths,
          .remedy = "fewer depths, ranges or sources"};
}

}  // namespace

MemoryBudget run_memory(const PropagationCase& run_case, MemoryBudget budget) {
  budget.take(run_case.task == Task::rays ? rays_need(run_case) : receivers_need(run_case));
  return budget;
}

}  // namespace asdic::detail
