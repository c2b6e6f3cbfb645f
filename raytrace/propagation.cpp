#include "raytrace/propagation.h"

#include "raytrace/beams/field_run.h"
#include "raytrace/runs/arrivals_run.h"
#include "raytrace/runs/rays_run.h"

namespace asdic {

PropagationResult run(const PropagationCase& run_case, const Progress& progress) {
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

}  // namespace asdic
