#pragma once
#include "core/memory_budget.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {

/// What run() and run_bellhop_emulation() ask of a budget before they begin: fields by their size,
/// rays and arrivals by how many there usually are. \return the budget with what was taken \throws
/// MemoryError if that is too much
[[nodiscard]] MemoryBudget run_memory(const PropagationCase& run_case, MemoryBudget budget);

}  // namespace asdic::detail
