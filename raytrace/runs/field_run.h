#pragma once
#include "raytrace/beams/fan.h"
#include "raytrace/beams/fan_field.h"
#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {

/// The field of a case (Task::field), for each of its sources. The number of beams grows until the
/// field is sure (docs/theory/fields.md), unless the case lists its elevations: then
/// these are the fan; in stratified water, if the case's `solver` lets it, the wave equation is
/// solved (waves/wave_field.h), and else in isovelocity water between flat boundaries images are
/// summed instead of beams (runs/image_field.h). The same bits for any number of threads. \throws
/// InputError  a source outside the water, no receivers, a fan without width \throws Interrupted
/// when `progress` says so
[[nodiscard]] PropagationResult run_field(const PropagationCase& run_case,
                                          const Progress& progress = {});

/// How far rays of a field are followed: to the receivers and a little beyond, within the box.
[[nodiscard]] TraceLimits field_limits(const PropagationCase& run_case);

/// The same numbers by two ways: closed forms and eight receivers at a time where they apply, or
/// one ray, one receiver after the other.
enum class FieldMethod { fast, plain };

/// What run_field repeats.
[[nodiscard]] FanField field_of_fan(const PropagationCase& run_case, const RayTracer& tracer,
                                    double source_depth, const BeamFan& fan,
                                    const Progress& progress = {},
                                    FieldMethod method = FieldMethod::fast,
                                    const FieldCheck& also = {});

}  // namespace asdic::detail
