#pragma once
#include <optional>

#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {

/// One beam out of a fan.
struct SingleBeam {
  double elevation = 0.0;  ///< [rad], positive up
  double spacing = 0.0;    ///< Δα of the whole fan, which makes the beam as wide as it is [rad]
};

/// The one beam that is wanted (LiteralSettings::single_beam) of the fan as it was written.
/// \throws InputError  the fan has no such beam
[[nodiscard]] std::optional<SingleBeam> single_beam(const PropagationCase& run_case);

/// The same case with a fan from half a spacing below the beam to half a spacing above it: what the
/// beam stands for. The cases of all beams share the paths of the fan among them.
[[nodiscard]] PropagationCase narrowed_to(const SingleBeam& beam, const PropagationCase& run_case);

}  // namespace asdic::detail
