#pragma once
#include <cmath>
#include <complex>

#include "raytrace/ocean/roughness.h"
#include "raytrace/tracing/ray_trajectory.h"

namespace asdic::detail {

/// What the boundaries have left of a ray's pressure. Pressures that are to be added are those of
/// the mean field. Where intensities are added its square is the energy: what rough boundaries
/// scattered about the ray belongs to it. \param coherent  pressures are added, else intensities
[[nodiscard]] inline std::complex<double> reflected(const RayHistory& history, bool coherent) {
  if (coherent || !(history.scattered > 0.0)) return history.reflection;
  return std::polar(std::sqrt(std::norm(history.reflection) + history.scattered),
                    history.reflection_phase);
}

/// The factor on pressure of one rough bounce, in the same sense. \param sine  of the grazing angle
/// \param wavenumber  k in the water at the boundary [rad/m]
[[nodiscard]] inline double left_by_roughness(const Roughness& roughness, double sine,
                                              double wavenumber, bool coherent) noexcept {
  const RoughReflection left = rough_reflection(roughness, sine, wavenumber);
  return coherent ? left.coherent : std::sqrt(left.energy);
}

}  // namespace asdic::detail
