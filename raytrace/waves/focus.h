#pragma once
#include <vector>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {

/// How far the amplitude of each ray may be off where its family focuses: the share of it that the
/// next order of stationary phase adds, (5/24)·ψ‴²/ψ″³ and ψ⁗/(8ψ″²), by how much the width of the
/// ray's tube differs a Fresnel zone to either side of it. Infinite where the family ends within
/// that. One ray that goes through a focus or beside a cusp has no other to tell it by.
/// docs/theory/waves.md, "Caustics"
/// \param solver  layered()   \param rays  found between these depths; `diffracted` ones are not
/// judged   \param faintest  share of their energy below which a ray is not [-]
/// \return [rays] of the amplitude
[[nodiscard]] std::vector<double> focusing_errors(const EigenraySolver& solver, double source_depth,
                                                  double receiver_depth, double frequency,
                                                  const PathLimits& limits, const Arrivals& rays,
                                                  double faintest);

}  // namespace asdic::detail
