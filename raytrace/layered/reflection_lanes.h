#pragma once
#include <array>

#include "core/level_namespace.h"
#include "raytrace/layered/column_lanes.h"
#include "raytrace/ocean/boundary.h"

namespace asdic {

inline namespace ASDIC_LEVEL {

/// Complex numbers in lanes.
struct ComplexLanes {
  Rays real = 1.0, imag = 0.0;

  friend ComplexLanes operator*(const ComplexLanes& a, const ComplexLanes& b) noexcept {
    return {a.real * b.real - a.imag * b.imag, a.real * b.imag + a.imag * b.real};
  }
};

}  // namespace ASDIC_LEVEL

/// reflection_coefficient (raytrace/ocean/boundary.h) of several rays, each to a power: what as
/// many bounces leave. \param sine, cosine  of the grazing angles   \param grazing  these [rad]
/// \param bounces  ≥ 0
[[nodiscard]] ComplexLanes reflections_of(const BoundaryMaterial& material,
                                          const WaterAtBoundary& water, const Rays& sine,
                                          const Rays& cosine, const Rays& grazing,
                                          std::array<int, rays_at_once> bounces) noexcept;

}  // namespace asdic
