#pragma once
#include "io/scenario/profiles/isovelocity.h"
#include "io/scenario/profiles/munk.h"
#include "io/scenario/profiles/section.h"
#include "io/scenario/profiles/table.h"
#include "io/scenario/profiles/temperature_salinity.h"

namespace asdic::detail::scenario {

/// Every way to say how fast sound is. A new one is its file and one name here
/// (docs/develop/recipes.md). The first can say all water that does not vary with range.
using AnyProfile = OneOfProfiles<TableProfile, MunkProfile, IsovelocityProfile,
                                 TemperatureSalinityProfile, SectionProfile>;

}  // namespace asdic::detail::scenario
