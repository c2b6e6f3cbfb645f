#pragma once
#include <optional>
#include <string>

#include "raytrace/beams/convergence.h"
#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"

namespace asdic::detail {

/// Why the wave equation is not solved for the field of this case: "the bottom is not flat"; "" if
/// it can be. What it costs is not asked.
[[nodiscard]] std::string why_no_waves(const PropagationCase& run_case);

/// The coherent field of a source in stratified water, by the wave equation: caustics, shadows,
/// leakage out of ducts and through barriers, head waves and modes near cut-off included. Nothing
/// if the case wants beams, or wants what is better and its waves are dearer than
/// `most_wave_steps`. The same bits for any number of threads. docs/theory/waves.md \param note
/// what the user should know if there is nothing; else untouched \throws InputError ("solver") if
/// waves are asked for where there are none \throws Interrupted
[[nodiscard]] std::optional<ConvergedField> wave_field(const PropagationCase& run_case,
                                                       double source_depth,
                                                       const Progress& progress, std::string& note);

/// Layers times wavenumbers that a field takes unasked: some 5 s of one core.
inline constexpr double most_wave_steps = 2e7;

}  // namespace asdic::detail
