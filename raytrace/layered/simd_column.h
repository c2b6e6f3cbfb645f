#pragma once
#include "raytrace/layered/column.h"
#include "raytrace/layered/simd_rays.h"

namespace asdic::detail {

inline namespace ASDIC_LEVEL {

/// One piece of ColumnSums and ColumnDetails for several rays, as functions of σ that are smooth up
/// to the vertical ray (σ = 1).
struct SimdLegs {
  Rays per_slowness = 0.0;  ///< r/ξ = ∫ c/s dz [m²/s]
  Rays d_range = 0.0;       ///< dr/dξ, finite part [m²/s]
  Rays intercept = 0.0;     ///< τ − ξr = ∫ s/c dz [s]
  Rays length = 0.0;        ///< ∫ 1/s dz [m]
};

struct SimdColumn {
  SimdLegs up, middle, down;
  bool turns_above = false, turns_below = false;
};

/// What became of rays that come to a layer through its slower edge; those that do not come are
/// neither.
struct LayerVisit {
  Rays::mask_type crossed, turned;
};

}  // namespace ASDIC_LEVEL

/// Adds to each ray that comes to a layer what it adds to r/ξ and dr/dξ, one way; zero to others.
/// \param between  a speed inside the rays' interval of the fan: what they do in a layer is the
/// same for all, but for those inside an analytic law
LayerVisit visit_layer(const Layer& layer, const SimdRays& rays, double between,
                       SimdLegs& leg) noexcept;

/// Adds what a layer that all rays cross adds to each, one way. \tparam detailed  with τ − ξr and
/// length \param sine_top, sine_bottom  sin θ at its edges
template <bool detailed>
void cross_layer(const Layer& layer, const SimdRays& rays, const Rays& sine_top,
                 const Rays& sine_bottom, SimdLegs& leg) noexcept;
/// The same of a layer that they all turn in. \param sine  at its slower edge
template <bool detailed>
void turn_in_layer(const Layer& layer, const SimdRays& rays, const Rays& sine,
                   SimdLegs& leg) noexcept;
/// What layers [first, last) of a column, which all rays cross, add up to.
template <bool detailed>
[[nodiscard]] SimdLegs cross_layers(const Column& column, std::size_t first, std::size_t last,
                                    const SimdRays& rays) noexcept;

/// Column::sums for several rays at once: the same sums, to rounding and the quadrature's 1e-10.
/// Intercepts and lengths are left out.
[[nodiscard]] SimdColumn walk_sums(const Column& column, const SimdRays& rays) noexcept;
/// Column::all for several rays at once.
[[nodiscard]] SimdColumn walk_all(const Column& column, const SimdRays& rays) noexcept;

}  // namespace asdic::detail
