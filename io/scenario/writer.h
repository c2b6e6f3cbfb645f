#pragma once
#include <string>

#include "raytrace/cases/propagation_case.h"

namespace asdic {

/// A run as a scenario file (docs/formats/scenario.md): read_propagation_case() makes the same case
/// of it, bit for bit. Angles are written in degrees where a decimal number of degrees reads back
/// as the same bits, else in radians.
[[nodiscard]] std::string to_toml(const PropagationCase& run_case);

/// The [environment] tables alone, for `include`.
[[nodiscard]] std::string to_toml(const Environment& environment);

}  // namespace asdic
