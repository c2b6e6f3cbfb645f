#pragma once
#include <optional>

#include "raytrace/beams/convergence.h"
#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"

namespace asdic::detail {

/// The field of a source in stratified water between flat boundaries, as the sum of its eigenrays:
/// what hats narrow to (narrows_to_paths). Nothing if the water is not that, if there are so many
/// paths that beams are cheaper, or if the source is on a kink of least speed, where the sum has no
/// limit (LevelRays). Paths of which reflections leave less than 10⁻⁴ are left out, as of beams;
/// what that is at most about is ConvergedField::error_db. docs/theory/fields.md, "Paths"
/// \throws Interrupted
[[nodiscard]] std::optional<ConvergedField> path_field(const PropagationCase& run_case,
                                                       double source_depth,
                                                       const Progress& progress = {});

}  // namespace asdic::detail
