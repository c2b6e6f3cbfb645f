#pragma once
#include <string>
#include <vector>

#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/ping_geometry.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// What is to be told of a ping's sound that is no rays': echoes and blasts that have the amplitude
/// of the pulse's centre where that changes by more than 1 dB to its edges, or changes faster than
/// it is computed; reverberation of ground that rays reach off the bottom alone, where waves would
/// add more than 0.1 dB. Empty over slopes. \param pulse  that is sent   \param array  that
/// receives it
[[nodiscard]] std::vector<std::string> wave_warnings(const PingGeometry& geometry,
                                                     const PropagationPaths& paths,
                                                     const Pulse& pulse, int array);

}  // namespace asdic::detail
