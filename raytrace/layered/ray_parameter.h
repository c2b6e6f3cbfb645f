#pragma once
#include <cmath>

namespace asdic::detail {

/// One ray of a layered ocean: its Snell invariant ξ = cos θ/c, held so that nothing cancels where
/// the ray is almost horizontal.
///
/// The ray is told by the sine σ of its angle at a depth where the speed is `reference_speed` (the
/// fastest speed it is sure to reach): ξ² = (1 − σ²)/c_ref². Then s² = 1 − ξ²c² = [(c_ref −
/// c)(c_ref + c) + σ²c²]/c_ref², accurate to rounding even where s → 0.
struct RayParameter {
  double reference_speed;  ///< c_ref [m/s]
  double sigma;            ///< σ, 0..1
  double slowness;         ///< ξ [s/m]
  double per_c2;           ///< 1/c_ref² [s²/m²]

  RayParameter(double c_ref, double sine)
      : reference_speed(c_ref),
        sigma(sine),
        slowness(std::sqrt((1.0 - sine) * (1.0 + sine)) / c_ref),
        per_c2(1.0 / (c_ref * c_ref)) {}

  /// sin²θ where the speed is c; negative where the ray does not come.
  [[nodiscard]] double sine2(double c) const noexcept {
    return ((reference_speed - c) * (reference_speed + c) + sigma * sigma * c * c) * per_c2;
  }
  /// The speed at which the ray turns, 1/ξ [m/s].
  [[nodiscard]] double turning_speed() const noexcept { return 1.0 / slowness; }
  /// dξ/dσ = −σ/(ξ·c_ref²) [s/m]
  [[nodiscard]] double slowness_per_sigma() const noexcept {
    return -sigma / (slowness * reference_speed * reference_speed);
  }
};

}  // namespace asdic::detail
