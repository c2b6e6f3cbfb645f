#pragma once
#include <string>

#include "core/memory_budget.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// What the samples of a ping's record take: once, and while a stream or receivers that are not
/// flat work on them again.
/// \param samples  of a phone   \param where  the key that says how long it is
[[nodiscard]] MemoryNeed record_need(const Scenario& scenario, double samples,
                                     const std::string& where = "pings.recording_duration");

}  // namespace asdic::detail
