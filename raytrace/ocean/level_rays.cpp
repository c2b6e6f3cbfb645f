#include "raytrace/ocean/level_rays.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

constexpr double beside = 1e-3;  // [m]

/// The sample of the profile nearest to a depth, if it is that near.
double kink_near(const Environment& environment, double depth) noexcept {
  const auto samples =
      environment.section ? environment.section->depths() : environment.water.depths();
  const auto next = std::lower_bound(samples.begin(), samples.end(), depth - beside);
  double nearest = depth, least = beside;
  for (auto sample = next; sample != samples.end() && *sample <= depth + beside; ++sample)
    if (const double apart = std::abs(*sample - depth); apart <= least) {
      least = apart;
      nearest = *sample;
    }
  return nearest;
}

LevelRays level_within(double share_of_wavelength, const Environment& environment, double frequency,
                       double range, double depth) noexcept {
  const double here = sound_speed(environment, range, depth).c;
  // Gradient away from the depth, extrapolated back to it; 0 at a smooth minimum.
  const auto rise = [&](double off) {
    const SoundSpeed2D there = sound_speed(environment, range, depth + off);
    return std::copysign(1.0, off) * (there.c_z - off * there.c_zz);
  };
  const double g = std::min(rise(-beside), rise(beside));
  constexpr double least_gradient = 1e-6;  // [1/s]
  if (!(g > least_gradient)) return {};
  const double height = share_of_wavelength * here / frequency;
  return {.angle = std::sqrt(2.0 * g * height / here),  // h = cα²/(2g)
          .height = height,
          .depth = kink_near(environment, depth)};
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
