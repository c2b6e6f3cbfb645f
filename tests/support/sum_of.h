#pragma once
#include <cmath>
#include <complex>

#include "core/units.h"
#include "raytrace/ocean/arrivals.h"

namespace asdic::detail::support {

/// The pressure that all arrivals make together at one frequency [1/m × 1 m].
inline std::complex<double> sum_of(const Arrivals& arrivals, double frequency) {
  std::complex<double> sum = 0.0;
  for (const Arrival& a : arrivals)
    sum += a.amplitude * std::polar(1.0, -2.0 * pi * std::fmod(frequency * a.delay, 1.0));
  return sum;
}

}  // namespace asdic::detail::support
