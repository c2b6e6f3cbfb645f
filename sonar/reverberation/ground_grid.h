#pragma once
#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/scenario.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// Speed of sound at the surface over the first platform's first place [m/s].
[[nodiscard]] double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths);

/// Spacing of the rings of the reverberation's grid [m]: as the scenario says, else by the pulse's
/// bandwidth; a surface with a shape is sampled facet by facet.
[[nodiscard]] double ground_spacing(const Scenario& scenario, const Pulse& pulse,
                                    const PropagationPaths& paths);

}  // namespace asdic::detail
