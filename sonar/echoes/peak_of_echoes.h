#pragma once
#include <span>

#include "sonar/echoes/echo_path.h"
#include "sonar/signal/band_limited_pulse.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// Largest envelope of the sum of echoes at the array's reference point, over the pulse's peak at 1
/// m, with the amplitudes of the centre frequency. Echoes count even if the record is too short for
/// them. They may cancel: a direct path and its surface reflection are a period apart or less.
///
/// Only times at which an echo is received are searched, and of those only as many as may hold the
/// peak. The cost is at most echoes × samples of a pulse.
/// Source: docs/theory/echoes.md, "Peak" \param recorded  the pulse as the phones record it
[[nodiscard]] double peak_of_echoes(const Pulse& pulse, std::span<const EchoPath> echoes,
                                    const BandLimitedPulse& recorded);

}  // namespace asdic::detail
