#include "raytrace/ocean/level_rays.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

LevelRays level_within(double share_of_wavelength, const Environment& environment, double frequency,
                       double range, double depth) noexcept {
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

}  // namespace

LevelRays level_rays(const Environment& environment, double frequency, double range,
                     double depth) noexcept {
  return level_within(1e-3, environment, frequency, range, depth);
}

LevelRays level_paths(const Environment& environment, double frequency, double range,
                      double depth) noexcept {
  return level_within(0.25, environment, frequency, range, depth);
}

void merge_level_paths(const LevelRays& level, Arrivals& arrivals) {
  const auto unreflected = [](const Arrival& a) { return a.bounces.empty(); };
  if (std::none_of(arrivals.begin(), arrivals.end(),
                   [&](const Arrival& a) { return a.launch_elevation == 0.0 && unreflected(a); }))
    return;
  std::erase_if(arrivals, [&](const Arrival& a) {
    return a.launch_elevation != 0.0 && unreflected(a) &&
           std::abs(a.launch_elevation) < level.angle &&
           std::abs(a.arrival_elevation) < level.angle;
  });
}

}  // namespace asdic::detail
