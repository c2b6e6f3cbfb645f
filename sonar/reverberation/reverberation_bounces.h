#pragma once
#include "raytrace/places/bounces.h"
#include "reverb/fields/scattering_parts.h"
#include "reverb/pairs/boundary_fans.h"
#include "sonar/reverberation/reverberation_context.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Bounces that are followed to what scatters and back: those after which a segment of the record
/// lacks next to nothing, found on a coarse grid. docs/theory/reverberation.md, "Many paths"
/// \param fan  its reach, frequency and limits on delays   \param layered  the ocean is
[[nodiscard]] Bounces reverberation_bounces(const ScatteringPart& part, const SheetEnds& ends,
                                            const BoundaryFans& fans, BoundaryFans::Settings fan,
                                            bool layered, const Scenario& scenario,
                                            const ReverberationContext& context);

}  // namespace asdic::detail
