#pragma once
#include <vector>

#include "sonar/paths/delay_curve.h"

namespace asdic::detail {

/// pulse_moments() of a path with a leg that waves make, whose delay may bend more in a pulse than
/// a cubic does: of ends that rise or sink, say. Segments are halved until the cubic through each
/// foretells its middle to negligible_phase, 64 of them at most.
[[nodiscard]] std::vector<PulseMoment> wave_moments(const MovingPath& path);

}  // namespace asdic::detail
