#pragma once
#include <vector>

#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// What a matched filter receives of sound that comes over even bins of delay about an echo,
/// E·∫|R|²dτ over each bin over ∫|R|²dτ over all, with R the pulse's autocorrelation and E its
/// energy [s]. Of power that is the same at all delays that is all of E, its level before the
/// filter; of power that is not, it is what answers at the echo's time.
/// \param step  of the bins [s]   \param width  of delays that echoes come with, evenly [s]
/// \return an odd number of weights, the middle of the echoes in the middle
[[nodiscard]] std::vector<float> filter_weights(const Pulse& pulse, double step, double width);

}  // namespace asdic::detail
