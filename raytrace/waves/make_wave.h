#pragma once
#include <complex>

#include "raytrace/ocean/arrivals.h"

namespace asdic::detail {

/// Gives a ray the amplitude of waves, of kind `caustic` then. \param times  the ray's own
inline void make_wave(Arrival& ray, std::complex<double> times) {
  ray.kind = ArrivalKind::caustic;
  ray.amplitude *= times;
  ray.spreading *= std::abs(times);
  ray.scattered *= std::norm(times);
}

}  // namespace asdic::detail
