#pragma once
#include <cmath>

#include "raytrace/environment.h"

namespace asdic {

/// The tube of rays about one of a point source, where it gets to.
struct RayTube {
  double speed = 0.0;             ///< c there [m/s]
  double q = 0.0;                 ///< ∂n/∂α, its width in the plane [m/rad]
  double range = 0.0;             ///< r ≥ 0 from the source [m]
  double launch_elevation = 0.0;  ///< α [rad]
  double source_speed = 0.0;      ///< c₀ [m/s]
  double speed_integral = 0.0;    ///< ∫c ds along the ray [m²/s]
};

/// |p| that the tube's area leaves of a unit source at 1 m, losses aside. Power keeps to the tube:
/// from the solid angle cos α·dα·dφ it spreads over |q|·dα·dy, so that
///
///   |p|² = c·cos α·dφ/(c₀·|q|·dy),   dy = (cos α/c₀)·∫c ds·dφ  (plane)   or   r·dφ  (cylindrical).
///
/// In a sea that is the same across the plane the slowness across it, η = cos α·dφ/c₀, is
/// conserved, and dy/ds = c·η. docs/theory/rays.md
[[nodiscard]] inline double tube_amplitude(Spreading spreading, const RayTube& tube) noexcept {
  if (spreading == Spreading::plane)
    return std::sqrt(tube.speed / (tube.speed_integral * std::abs(tube.q)));
  return std::sqrt(tube.speed * std::abs(std::cos(tube.launch_elevation)) /
                   (tube.source_speed * tube.range * std::abs(tube.q)));
}

}  // namespace asdic
