#pragma once
#include "raytrace/layered/simd_column.h"

namespace asdic::detail {

/// Quadratures through layers without a closed form (cubics, Munk's law) for several rays at once;
/// what `cross` and `turn` of layer_pass.h are for one ray. docs/theory/layered-rays.md
///
/// Lanes know layers that are evenly bent, or steep enough for nodes in depth that all rays share;
/// what is left, next to an extremum of the speed, goes ray by ray.
template <bool detailed>
void cross_smooth(const Layer& layer, const SimdRays& rays, const Rays& sine_top,
                  const Rays& sine_bottom, SimdLegs& leg) noexcept;

/// From the slower edge to the turning depths. \param sine  at that edge
template <bool detailed>
void turn_smooth(const Layer& layer, const SimdRays& rays, const Rays& sine,
                 SimdLegs& leg) noexcept;

}  // namespace asdic::detail
