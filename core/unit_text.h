#pragma once
#include <string>

#include "core/quantity.h"

namespace asdic::detail {

/// What a quantity's numbers are counted in: "m", "dB re 1 µPa at 1 m"; "" without a unit.
[[nodiscard]] std::string unit_of(const Quantity& quantity);

}  // namespace asdic::detail
