#pragma once
#include "raytrace/layered/layer.h"
#include "raytrace/layered/ray_parameter.h"

namespace asdic::detail {

/// What one way through a layer, or from its edge to the turning depth inside it, adds to the
/// horizontal range.
struct Pass {
  double range = 0.0;  ///< [m]
  double d_range =
      0.0;  ///< dr/dξ; at a turning point its finite part, which is what q needs [m²/s]

  Pass& operator+=(const Pass& other) noexcept {
    range += other.range;
    d_range += other.d_range;
    return *this;
  }
};

/// What the same way adds to time and length.
struct PassDetail {
  double time = 0.0;    ///< [s]
  double length = 0.0;  ///< [m]

  PassDetail& operator+=(const PassDetail& other) noexcept {
    time += other.time;
    length += other.length;
    return *this;
  }
};

/// The same for c linear in depth: Δr = ξ(c_a + c_b)h/(s_a + s_b), ∂r/∂ξ = Δr/(ξ s_a s_b), with one
/// division.
[[nodiscard]] inline Pass cross_c_linear(const Layer& layer, const RayParameter& ray,
                                         double sine_top, double sine_bottom) noexcept {
  const double product = sine_top * sine_bottom;
  const double d_range =
      (layer.c_top + layer.c_bottom) * layer.thickness() / ((sine_top + sine_bottom) * product);
  return {.range = ray.slowness * d_range * product, .d_range = d_range};
}

/// From top to bottom (or back) through a layer that the ray crosses. \param sine_top, sine_bottom
/// sin θ > 0 at its edges c-linear: Δr = ξ(c_a + c_b)h/(s_a + s_b); n²-linear: Δr = 2ξh/(w_a +
/// w_b), w = s/c; smooth laws by quadrature. docs/theory/layered-rays.md
[[nodiscard]] Pass cross(const Layer& layer, const RayParameter& ray, double sine_top,
                         double sine_bottom) noexcept;
[[nodiscard]] PassDetail cross_detail(const Layer& layer, const RayParameter& ray, double sine_top,
                                      double sine_bottom) noexcept;

/// From the slower edge of a layer to the depth inside it where the ray turns, one way. \param sine
/// sin θ > 0 at that edge
[[nodiscard]] Pass turn(const Layer& layer, const RayParameter& ray, double sine) noexcept;
[[nodiscard]] PassDetail turn_detail(const Layer& layer, const RayParameter& ray,
                                     double sine) noexcept;

/// The depth inside the layer where the ray turns: c(z) = 1/ξ [m].
[[nodiscard]] double turning_depth(const Layer& layer, const RayParameter& ray) noexcept;

}  // namespace asdic::detail
