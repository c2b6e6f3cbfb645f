#include "raytrace/tracing/level_rays.h"

#include <algorithm>
#include <cmath>

namespace asdic {

LevelRays level_rays(const Environment& environment, double frequency, double range,
                     double depth) noexcept {
  constexpr double share_of_wavelength = 1e-3;
  constexpr double beside = 1e-3;  // of the kink [m]: where c is smooth its slope there is nothing
  const auto c = [&](double z) { return sound_speed(environment, range, z).c; };
  const double here = c(depth);
  const double above = (c(depth - beside) - here) / beside;
  const double below = (c(depth + beside) - here) / beside;
  const double g = std::min(above, below);
  constexpr double least_gradient = 1e-6;  // [1/s] what a smooth minimum has 1 mm from it
  if (!(g > least_gradient)) return {};
  const double height = share_of_wavelength * here / frequency;
  return {.angle = std::sqrt(2.0 * g * height / here), .height = height};  // h = cα²/(2g)
}

}  // namespace asdic
