#pragma once
#include <vector>

#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// |χ(τ, η)|² of a pulse in cells of delay and Doppler factor, for a picture: of each cell the
/// largest value within, so that nails narrower than a cell are seen.
///
/// χ(τ, η) = √η/E·∫ s₊(η(t − τ))·s₊*(t) dt: what the filter matched to η = 1 makes of an echo of
/// factor η that comes τ late.
struct PulseAmbiguity {
  std::vector<double> delays;    ///< [n] of the cells' middles, 0 among them [s]
  std::vector<double> dopplers;  ///< [m] factors, 1 among them
  std::vector<double> power;     ///< [m × n], 1 at (0, 1)
};

/// \param reach  to which delay, to either side [s]   \param shift  to which Doppler shift of the
/// centre, to either side [Hz]
[[nodiscard]] PulseAmbiguity pulse_ambiguity(const Pulse& pulse, double reach, double shift);
/// As far as there is something to see: ten cells of a tone's or a sweep's ridge, the nails of a
/// train, the hops of a Costas pulse.
[[nodiscard]] PulseAmbiguity pulse_ambiguity(const Pulse& pulse);

}  // namespace asdic::detail
