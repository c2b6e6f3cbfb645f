#pragma once
#include "core/memory_budget.h"
#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"

namespace asdic::detail {

/// Runs a case with asdic's own tracer. Results do not depend on the number of threads.
/// \param budget  that the run keeps within
/// \throws InputError if the case makes no sense (a source outside the water, no receivers);
/// MemoryError if it is too large
[[nodiscard]] PropagationResult run(const PropagationCase& run_case, const Progress& progress = {},
                                    const MemoryBudget& budget = {});

/// The same case as BELLHOP does it: its own steps, landing rules, beam formulas and merging, for
/// comparison (docs/theory/bellhop-emulation.md). The field has asdic's sign.
[[nodiscard]] PropagationResult run_bellhop_emulation(const PropagationCase& run_case,
                                                      const Progress& progress = {},
                                                      const MemoryBudget& budget = {});

}  // namespace asdic::detail
