#pragma once
#include "core/simd.h"

namespace asdic::detail {

inline namespace ASDIC_LEVEL {

/// One number for each of several rays, as many as the machine adds at once.
using Rays = SimdDoubles;
inline constexpr std::size_t rays_at_once = Rays::size();

/// RayParameter of several rays of one interval of the fan, which turn in the same layers.
struct SimdRays {
  double reference_speed;  ///< c_ref [m/s]
  double per_c2;           ///< 1/c_ref² [s²/m²]
  Rays sigma;              ///< σ, 0..1
  Rays slowness;           ///< ξ [s/m]

  SimdRays(double c_ref, const Rays& sine) noexcept
      : reference_speed(c_ref),
        per_c2(1.0 / (c_ref * c_ref)),
        sigma(sine),
        slowness(sqrt((1.0 - sine) * (1.0 + sine)) / c_ref) {}

  /// sin²θ where the speed is c; negative where the rays do not come.
  [[nodiscard]] Rays sine2(double c) const noexcept {
    return (reference_speed - c) * (reference_speed + c) * per_c2 +
           sigma * sigma * (c * c * per_c2);
  }
  /// sin θ, of rays that come there.
  [[nodiscard]] Rays sine(double c) const noexcept { return sqrt(max(sine2(c), Rays(1e-300))); }
};

/// Those of the rays that a mask names, one of them in the place of every other.
[[nodiscard]] inline SimdRays only(const SimdRays& rays, const Rays::mask_type& these) noexcept {
  SimdRays some = rays;
  const auto one = static_cast<std::size_t>(find_first_set(these));
  where(!these, some.sigma) = rays.sigma[one];
  where(!these, some.slowness) = rays.slowness[one];
  return some;
}

}  // namespace ASDIC_LEVEL

}  // namespace asdic::detail
