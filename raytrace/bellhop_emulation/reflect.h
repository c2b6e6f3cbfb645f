#pragma once
#include "raytrace/bellhop_emulation/step.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail::bellhop_emulation {

/// The ray after a reflection at its place: mirrored tangent, p with the jumps of the boundary's
/// curvature and of the sound speed's gradient, amplitude and phase with the coefficient. An
/// amplitude of 0 says that nothing was reflected.
LiteralPoint reflect(const LiteralOcean& ocean, const LiteralPoint& in, BoundaryKind kind,
                     RayPlace& place, CervenyBeams::Curvature curvature) noexcept;

}  // namespace asdic::detail::bellhop_emulation
