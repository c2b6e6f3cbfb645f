#pragma once
#include "raytrace/ocean/boundary.h"

namespace asdic::detail {

/// Where a material reflects most, of grazing angles 0.1° apart.
struct StrongestReflection {
  double grazing = 0.0;    ///< [rad]
  double magnitude = 0.0;  ///< |R|; above 1 the boundary would give energy
};
[[nodiscard]] StrongestReflection strongest_reflection(const BoundaryMaterial& material,
                                                       const WaterAtBoundary& water) noexcept;

/// |R| above this is not the rounding of a program that made the numbers.
inline constexpr double most_reflection = 1.0 + 1e-6;

}  // namespace asdic::detail
