#pragma once
#include "core/level_namespace.h"
#include "raytrace/layered/layer.h"
#include "raytrace/layered/simd_rays.h"

namespace asdic::detail {

inline namespace ASDIC_LEVEL {

/// Layer::at for lanes of depths.
struct SimdWater {
  Rays c, dc_dz, d2c_dz2;

  SimdWater(const Layer& layer, const Rays& depth) noexcept {
    const auto& a = layer.coefficient;
    if (layer.law == Layer::Law::cubic) {
      const Rays t = depth - layer.origin;
      c = a[0] + t * (a[1] + t * (a[2] + t * a[3]));
      dc_dz = a[1] + t * (2.0 * a[2] + t * (3.0 * a[3]));
      d2c_dz2 = 2.0 * a[2] + t * (6.0 * a[3]);
    } else {  // c = c₁[1 + ε(η − 1 + e^−η)], η = 2(z − z₁)/B
      const double k = 2.0 / a[2], slope = a[0] * a[3] * k;
      const Rays eta = k * (depth - a[1]), decay = exponential(-eta);
      c = a[0] * (1.0 + a[3] * (eta - 1.0 + decay));
      dc_dz = slope * (1.0 - decay);
      d2c_dz2 = slope * k * decay;
    }
  }
};

}  // namespace ASDIC_LEVEL

}  // namespace asdic::detail
