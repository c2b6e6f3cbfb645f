#pragma once
#include "io/bellhop/case_reader.h"
#include "raytrace/propagation.h"

namespace asdic::detail::bellhop {

/// Runs a case that was read, in all its planes: fields and arrivals are those of the planes
/// (MapInput::planes) one after another. Of a case without a map the one that there is.
/// \param like_bellhop  as run_bellhop_emulation() does it, in planes
[[nodiscard]] PropagationResult run_all_planes(const Input& input, bool like_bellhop,
                                               const Progress& progress = {},
                                               const MemoryBudget& budget = {});

}  // namespace asdic::detail::bellhop
