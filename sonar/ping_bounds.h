#pragma once
#include "sonar/propagation_paths.h"
#include "sonar/pulse.h"
#include "sonar/scenario.h"

namespace asdic {

/// Fastest that a track ever moves [m/s].
[[nodiscard]] double fastest(const Track& track);

/// A bound on |η − 1| over everything in the scenario: each of source, target (twice) and receiver
/// contributes at most v/c.
[[nodiscard]] double doppler_bound(const Scenario& scenario);

/// Speed of sound at the surface over the first platform's first place [m/s].
[[nodiscard]] double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths);

/// Fastest speed of sound anywhere in the water [m/s].
[[nodiscard]] double fastest_water(const Environment& ocean);

/// Spacing of the rings of the reverberation's grid [m]: as the scenario says, else by the pulse's
/// bandwidth; a surface with a shape is sampled facet by facet.
[[nodiscard]] double ground_spacing(const Scenario& scenario, const Pulse& pulse,
                                    const PropagationPaths& paths);

}  // namespace asdic
