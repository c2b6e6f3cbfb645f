#pragma once
#include <memory>

#include "reverb/power/pulse_coherence.h"

namespace asdic::detail {

class Pulse;

/// That of a pulse, at samples 16 times as dense as its band asks for: right to 0.005 between them.
/// Each thread remembers it for the last few: a millisecond to find.
[[nodiscard]] std::shared_ptr<const PulseCoherence> pulse_coherence(const Pulse& pulse);

}  // namespace asdic::detail
