#pragma once
#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"

namespace asdic::detail {

/// A case in three dimensions (PropagationCase::dimension): eigenrays through the volume to every
/// receiver, and a field as their sum. The source's pattern and the limits of the fan count as in a
/// plane. The same bits for any number of threads. docs/theory/three-dimensional-rays.md
/// \throws InputError  what three dimensions do not do: drawn rays, lines, semi-coherent fields,
/// the wave equation, a surface with a shape   \throws Interrupted when `progress` says so
[[nodiscard]] PropagationResult run_volume(const PropagationCase& run_case,
                                           const Progress& progress = {});

}  // namespace asdic::detail
