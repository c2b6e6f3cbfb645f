#pragma once
#include "raytrace/layered/layer.h"

namespace asdic::detail {

/// How much slower the water of a cubic layer is at a distance t [m] from one of its depths than
/// there, c(z₀) − c(z₀ ± t) [m/s], out of the law about z₀.
///
/// Next to a turning point, and to a smooth maximum of the speed, this difference is all that sin²θ
/// is made of, and speeds known to 2e-13 m/s do not tell it. \tparam T  double, or lanes of depths
template <class T>
class SpeedDrop {
 public:
  /// \param here  speed and slopes at z₀   \param third  d³c/dz³/6 of the layer
  /// \param sign  of the way: +1 down, −1 up
  SpeedDrop(const T& slope, const T& bend, double third, double sign) noexcept
      : linear_(-sign * slope), square_(-0.5 * bend), cube_(-sign * third) {}

  template <class Way>
  [[nodiscard]] auto operator()(const Way& t) const noexcept {
    return t * (linear_ + t * (square_ + t * cube_));
  }
  /// Its slope along the way.
  template <class Way>
  [[nodiscard]] auto slope(const Way& t) const noexcept {
    return linear_ + t * (2.0 * square_ + t * (3.0 * cube_));
  }

 private:
  T linear_, square_;
  double cube_;
};

[[nodiscard]] inline SpeedDrop<double> speed_drop(const Layer& layer, double depth,
                                                  double sign) noexcept {
  const SoundSpeed here = layer.at(depth);
  return {here.dc_dz, here.d2c_dz2, layer.coefficient[3], sign};
}

/// Whether the top of a layer is its faster edge, where rays that cross it are flattest. By the
/// slope: next to an extremum the edges' speeds may be the same, or rounded past each other.
[[nodiscard]] inline bool falls(const Layer& layer) noexcept {
  return layer.at(0.5 * (layer.top + layer.bottom)).dc_dz < 0.0;
}

}  // namespace asdic::detail
