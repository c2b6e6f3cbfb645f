#include "raytrace/ocean/roughness.h"

#include <algorithm>
#include <cmath>

namespace asdic {

double coherent_reflection(const Roughness& roughness, double sine, double wavenumber) noexcept {
  if (roughness.smooth()) return 1.0;
  const double g = 2.0 * wavenumber * roughness.rms_height * sine;
  return std::max(std::exp(-0.5 * g * g), std::pow(10.0, roughness.floor_db / 20.0));
}

double pierson_moskowitz_height(double wind_speed) noexcept {
  constexpr double gravity = 9.81;      // [m/s²]
  const double u = 1.026 * wind_speed;  // at 19.5 m
  return 0.0523 * u * u / gravity;
}

}  // namespace asdic
