#pragma once
#include "raytrace/tracing/cell.h"

namespace asdic::detail::tracing {

/// A line met by a ray: the direction β of its tangent (cos β, sin β) and how it bends.
struct Tangent {
  double r = 1.0, z = 0.0;  ///< unit vector
  double curvature = 0.0;   ///< dβ/ds [1/m]
};

/// Reflection: t → t − 2(t·n)n, and the beam's p jumps. Let a neighbouring ray strike the boundary
/// dl = q·dα / sin(β − φ) further on. There the boundary has turned by κ·dl, and both rays' own
/// bends, −c_n/c, count over ds = dl·cos(β − φ). With q counted along the normal that flips at a
/// reflection,
///
///   p → p + q/(c·sin(β − φ)) · [ −∇c·(n_in + n_out)/c · cos(β − φ) − 2κ ]
///
/// docs/theory/reflections.md; for a flat bottom it is Δp = 2c_z cos²θ q/(c² sin θ).
/// \return grazing angle [rad]
double reflect(RayState& y, const Local& water, const Tangent& boundary) noexcept;

/// Crossing a line where the gradient of c jumps, c itself being continuous:
///
///   p → p + q/c² · [∇c]·n · cot(β − φ)
void cross(RayState& y, const Local& before, const Local& after, const Tangent& line) noexcept;

}  // namespace asdic::detail::tracing
