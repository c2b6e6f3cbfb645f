#pragma once
#include "study/placement/placement_plan.h"

namespace asdic::detail::study {

/// Reads a plan (docs/formats/placement.md) and checks it; scenarios are checked as they stand.
/// \throws InputError "FILE:LINE: key.path: found X, expected Y" at the first fault
[[nodiscard]] PlacementPlan read_placement(const std::filesystem::path& path,
                                           std::span<const std::string> overrides = {});

}  // namespace asdic::detail::study
