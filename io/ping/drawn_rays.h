#pragma once
#include "io/ping/ping_file.h"
#include "sonar/ping/ping.h"

namespace asdic::detail {

/// The rays of the first ping, for drawing: a fan over the beam (three beamwidths, or ±20° if it is
/// omnidirectional) out to a bit past the furthest target, or the furthest place where the fan
/// meets the surface and an echo from there would still be recorded; and the eigenrays to the
/// targets.
[[nodiscard]] RayPaths drawn_rays(const PingSimulator& simulator);

}  // namespace asdic::detail
