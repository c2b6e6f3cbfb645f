#pragma once
#include <complex>

namespace asdic::detail {

/// A ray and its beam where it first crosses a range.
struct RayAtRange {
  bool arrived = false;    ///< false: it turned back, or a boundary kept it
  double depth = 0.0;      ///< [m]
  double elevation = 0.0;  ///< of travel there, positive up [rad]
  double time = 0.0;       ///< τ [s]
  double q = 0.0;          ///< ∂n/∂(launch angle) [m/rad]
  double p = 0.0;          ///< dq/ds = c·p
  int surface_bounces = 0, bottom_bounces = 0, turns = 0, caustics = 0;
  std::complex<double> reflection = 1.0;  ///< product of the boundaries' coefficients
};

}  // namespace asdic::detail
