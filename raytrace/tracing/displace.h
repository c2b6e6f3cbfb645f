#pragma once
#include "raytrace/ocean/beam_displacement.h"
#include "raytrace/tracing/jumps.h"

namespace asdic::detail::tracing {

/// A displaced reflection: what was met, and where the ray leaves.
struct DisplacedReflection {
  RayState in;                ///< before the reflection, on the boundary
  Local water;                ///< there
  Tangent hit;                ///< of the boundary there
  Local water_beyond;         ///< where the ray leaves
  Tangent leave;              ///< of the boundary there
  double displacement = 0.0;  ///< D along `hit`, positive towards greater ranges [m]
  BeamDisplacement rates;     ///< and how it varies
};

/// How far along a boundary's tangent, towards greater ranges, a ray is displaced [m].
[[nodiscard]] double signed_displacement(const RayState& in, const Tangent& hit,
                                         const BeamDisplacement& moved) noexcept;

/// The beam of a displaced reflection: p and q of both solutions and the delay of `y`, which has
/// been put where the ray leaves, in the direction in which it was reflected. Let dl be the
/// distance of a neighbour's hit. It leaves dl + dD further on,
///
///   dD = ±Δ_θ·dγ ± Δ_c·(∇c·u)·dl,   dγ = κ·dl − (c·p·dα + κ_ray·dl·cos γ),   γ = β − φ,
///
/// and q and p are those of two rays that far apart. The delay grows by k_t·D/ω, so that with the
/// phase of the coefficient ωτ − φ has the slowness as its gradient. docs/theory/reflections.md
/// \return by how much the number of caustics changes: dl/dk_t may pass zero, upwards (+1) or
/// downwards (−1)
int displace(const DisplacedReflection& r, RayState& y) noexcept;

}  // namespace asdic::detail::tracing
