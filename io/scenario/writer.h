#pragma once
#include <string>

#include "raytrace/cases/propagation_case.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// A run as a scenario file (docs/formats/scenario.md): read_propagation_case() makes the same case
/// of it, bit for bit. Angles are written in degrees where a decimal number of degrees reads back
/// as the same bits, else in radians.
[[nodiscard]] std::string to_toml(const PropagationCase& run_case);

/// The [environment] tables alone, for `include`.
[[nodiscard]] std::string to_toml(const Environment& environment);

/// A scenario, whatever it was made of, without its text and overrides: read_scenario() makes the
/// same scenario of it, bit for bit, if what the reader works out is worked out in this one.
/// \throws InputError where a file cannot say it
[[nodiscard]] std::string to_toml(const Scenario& scenario);

}  // namespace asdic::detail
