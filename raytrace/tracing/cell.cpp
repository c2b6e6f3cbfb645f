#include "raytrace/tracing/cell.h"

#include <cmath>

namespace asdic::detail::tracing {

/// c = c₁[1 + ε(η − 1 + e^(−η))], η = 2(z − z₁)/B; Munk, JASA 55, 220 (1974).
SoundSpeed2D Cell::munk_speed(double depth) const noexcept {
  const double per_metre = 2.0 / munk->scale_depth;
  const double eta = per_metre * (depth - munk->axis_depth);
  const double decay = std::exp(-eta), strength = munk->axis_speed * munk->perturbation;
  return {.c = munk->axis_speed + strength * (eta - 1.0 + decay),
          .c_z = strength * (1.0 - decay) * per_metre,
          .c_zz = strength * decay * per_metre * per_metre};
}

}  // namespace asdic::detail::tracing
