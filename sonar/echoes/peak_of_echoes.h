#pragma once
#include <complex>
#include <span>
#include <vector>

#include "sonar/echoes/echo_path.h"
#include "sonar/signal/band_limited_pulse.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// Echoes through one of the responses that serve a pulse's band, or through the only one.
struct EchoesOfBand {
  BandLimitedPulse pulse;
  std::vector<std::complex<double>> amplitudes;  ///< [echoes]
};

/// Largest envelope of echoes as they add at the array's reference point, over the pulse's peak at
/// 1 m: the sum of all responses as the phones record it, whether or not the record is that long.
/// Echoes may cancel: a direct path and its surface reflection are a period apart or less.
///
/// Only times at which an echo is received are looked at, and of those only as many as may hold the
/// peak: the cost is at most echoes × samples of a pulse × responses.
/// Source: docs/theory/echoes.md, "Peak"
[[nodiscard]] double peak_of_echoes(const Pulse& pulse, std::span<const EchoPath> echoes,
                                    std::span<const EchoesOfBand> band);

}  // namespace asdic::detail
