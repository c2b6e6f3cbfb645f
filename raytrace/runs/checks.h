#pragma once
#include "raytrace/cases/propagation_case.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {

/// What every run asks of a case: water that is deep enough, sources in it, a fan with width.
/// \throws InputError naming the first thing that makes no sense
void check_sources(const PropagationCase& run_case);

/// And receivers, for runs that have any. \throws InputError
void check_receivers(const PropagationCase& run_case);

/// Whether the pressure at a source at this depth (range 0) is zero, come what may: on a smooth
/// boundary with a vacuum.
[[nodiscard]] bool on_vacuum(const Environment& ocean, double depth) noexcept;

/// The marching solver as a run asks for it: at its frequency, displaced at reflections or not. The
/// layered solver knows no displacement; runs that ask for it march (`beams.displacement`).
[[nodiscard]] RayTracer tracer_of(const PropagationCase& run_case);

}  // namespace asdic::detail
