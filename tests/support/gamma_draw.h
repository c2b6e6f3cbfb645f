#pragma once
#include <cmath>

#include "core/random.h"

namespace asdic::detail::support {

/// A gamma variable of unit mean (Marsaglia & Tsang, ACM TOMS 26, 363, 2000). \param shape  above 0
inline double gamma_draw(double shape, RandomStream& random) {
  if (shape < 1.0)
    return gamma_draw(shape + 1.0, random) * (shape + 1.0) / shape *
           std::pow(random.uniform(), 1.0 / shape);
  const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  while (true) {
    const double x = random.normal(), v = std::pow(1.0 + c * x, 3.0);
    if (v > 0.0 && std::log(random.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v))
      return d * v / shape;
  }
}

}  // namespace asdic::detail::support
