#pragma once
#include <span>
#include <vector>

#include "sonar/paths/returns.h"
#include "sonar/signal/pulse.h"
#include "sonar/signal/recording.h"

namespace asdic::detail {

/// The reference: every return's exact stretched pulse evaluated at every sample. \return [phones ×
/// recording.samples]
[[nodiscard]] std::vector<double> direct_synthesis(const Pulse& pulse, const Recording& recording,
                                                   std::span<const Return> returns,
                                                   std::span<const Vec3> phones);

}  // namespace asdic::detail
