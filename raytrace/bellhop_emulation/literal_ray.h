#pragma once
#include <complex>
#include <vector>

#include "core/units.h"

namespace asdic::detail::bellhop_emulation {

/// A point of a ray where a step ended; at a reflection there are two at one place. The tangent is
/// scaled: unit tangent / c. p and q are two real solutions of the dynamic equations: the first
/// starts with p = 1, q = 0 (a point source), the second with p = 0, q = 1.
struct LiteralPoint {
  Vec2 x = Vec2::Zero();         ///< (range, depth) [m]
  Vec2 t = Vec2::Zero();         ///< [s/m]
  double c = 0.0;                ///< [m/s]
  Vec2 gradient = Vec2::Zero();  ///< of c, by the cell that the ray goes into [1/s]
  double p1 = 1.0, q1 = 0.0;
  double p2 = 0.0, q2 = 1.0;
  std::complex<double> tau = 0.0;  ///< delay; its imaginary part, ≤ 0, is the absorption/ω [s]
  double amplitude = 1.0;          ///< source pattern × |reflections|
  double phase = 0.0;              ///< of the reflections, not wrapped [rad]
  int surface_bounces = 0, bottom_bounces = 0;
};

/// One ray of the fan.
struct LiteralRay {
  double declination = 0.0;  ///< at launch [rad], positive down
  std::vector<LiteralPoint> points;
};

}  // namespace asdic::detail::bellhop_emulation
