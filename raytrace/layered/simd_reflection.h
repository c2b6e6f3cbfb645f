#pragma once
#include <array>

#include "core/level_namespace.h"
#include "raytrace/layered/simd_column.h"
#include "raytrace/ocean/boundary.h"

namespace asdic::detail {

inline namespace ASDIC_LEVEL {

/// Complex numbers in lanes.
struct SimdComplex {
  Rays real = 1.0, imag = 0.0;

  friend SimdComplex operator*(const SimdComplex& a, const SimdComplex& b) noexcept {
    return {a.real * b.real - a.imag * b.imag, a.real * b.imag + a.imag * b.real};
  }
};

}  // namespace ASDIC_LEVEL

/// reflection_coefficient (raytrace/ocean/boundary.h) of several rays, each to a power: what as
/// many bounces leave. \param sine, cosine  of the grazing angles   \param grazing  these [rad]
/// \param bounces  ≥ 0
[[nodiscard]] SimdComplex reflections_of(const BoundaryMaterial& material,
                                         const WaterAtBoundary& water, const Rays& sine,
                                         const Rays& cosine, const Rays& grazing,
                                         std::array<int, rays_at_once> bounces) noexcept;

}  // namespace asdic::detail
