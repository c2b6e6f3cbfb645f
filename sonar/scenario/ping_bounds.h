#pragma once
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Fastest that a track ever moves [m/s].
[[nodiscard]] double fastest(const Track& track);

/// A bound on |η − 1| over everything in the scenario: each of source, target (twice) and receiver
/// contributes at most v/c.
[[nodiscard]] double doppler_bound(const Scenario& scenario);

/// Fastest speed of sound anywhere in the water [m/s].
[[nodiscard]] double fastest_water(const Environment& ocean);
/// The same of all that is heard of a scenario's ocean about its first platform.
[[nodiscard]] double fastest_water(const Scenario& scenario);

}  // namespace asdic::detail
