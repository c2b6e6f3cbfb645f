#pragma once
#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {

/// The rays of a case (Task::rays), for each of its sources: exactly as many as it says (0: 50),
/// out to its box or until reflections have left 0.005 of them. Straight lines between their points
/// are within 5 cm of the ray. \throws InputError \throws Interrupted
[[nodiscard]] PropagationResult run_rays(const PropagationCase& run_case,
                                         const Progress& progress = {});

/// Ends rays where the box of a case does, below and above.
void limit_depth(const PropagationCase& run_case, TraceLimits& limits) noexcept;

/// Where the rays of a case end.
[[nodiscard]] TraceLimits box_of(const PropagationCase& run_case);

}  // namespace asdic::detail
