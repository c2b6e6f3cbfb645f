#pragma once
#include <vector>

#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// The pulse of a transmitter as a matched filter of its records needs it, of unit peak before its
/// window. \return [n] real at the phones' rate, or [2 × n] real and imaginary part in turn about
/// the baseband's carrier
[[nodiscard]] std::vector<float> recorded_replica(const Scenario& scenario, int transmitter);

}  // namespace asdic::detail
