#pragma once
#include "sonar/propagation_paths.h"
#include "sonar/pulse.h"
#include "sonar/scenario.h"
#include "sonar/surface_ground.h"

namespace asdic {

/// Fastest that a track ever moves [m/s].
[[nodiscard]] double fastest(const Track& track);

/// A bound on |η − 1| over everything in the scenario: each of source, target (twice) and receiver
/// contributes at most v/c.
[[nodiscard]] double doppler_bound(const Scenario& scenario);

/// Speed of sound at the surface over the first platform's first place [m/s].
[[nodiscard]] double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths);

/// The ground grid of the surface's reverberation: spacing by the pulse's bandwidth, out to the end
/// of the record.
[[nodiscard]] SurfaceGround::Settings ground_settings(const Scenario& scenario, const Pulse& pulse,
                                                      const PropagationPaths& paths);

}  // namespace asdic
