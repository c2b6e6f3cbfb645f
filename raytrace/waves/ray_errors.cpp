#include "raytrace/waves/ray_errors.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/waves/focus.h"

namespace asdic::detail {
namespace {

constexpr double faintest_focus = 1e-4;  // of the rays' energy
constexpr double most_of_a_turn = 1.5;   // [rad]
constexpr double of_a_caustic = 0.1;     // what a pair's amplitudes may be off by at most

/// A depth at which the gradient of the speed jumps.
struct Corner {
  double speed, steepest, jump;  // [m/s], gradients [1/s]
};

std::vector<Corner> corners_of(const Environment& ocean, bool boundaries) {
  std::vector<Corner> corners;
  const SoundSpeedProfile& water = ocean.water;
  for (std::size_t i = 1; i < water.intervals(); ++i) {
    const double depth = water.law(i).z0;
    const double above = water.at(depth, i - 1).dc_dz, below = water.at(depth, i).dc_dz;
    corners.push_back({.speed = water.at(depth).c,
                       .steepest = std::max(std::abs(above), std::abs(below)),
                       .jump = std::abs(above - below)});
  }
  if (boundaries)
    for (const double depth : {ocean.surface.depth, ocean.bottom.depth}) {
      const SoundSpeed there = water.at(depth);
      corners.push_back({there.c, std::abs(there.dc_dz), std::abs(there.dc_dz)});
    }
  std::erase_if(corners, [](const Corner& corner) { return !(corner.jump > 0.0); });
  return corners;
}

}  // namespace

std::vector<double> corner_errors(const Environment& ocean, double frequency, const Arrivals& rays,
                                  bool boundaries) {
  const std::vector<Corner> corners = corners_of(ocean, boundaries);
  std::vector<double> errors;
  for (const Arrival& ray : rays) {
    double worst = 0.0;
    const int turns = ray.upper_turns + ray.lower_turns,
              bounces = boundaries ? ray.surface_bounces + ray.bottom_bounces : 0;
    for (const Corner& corner : corners) {
      const double k = 2.0 * pi * frequency / corner.speed;
      const double length = std::cbrt(corner.speed / (2.0 * k * k * corner.steepest));
      const double away =
          std::abs(1.0 / ray.horizontal_slowness - corner.speed) / corner.steepest / length;
      worst = std::max(worst, corner.jump / corner.steepest * 0.25 * std::pow(away, -1.5));
    }
    const bool judged = ray.kind != ArrivalKind::diffracted;
    errors.push_back(judged ? (turns + bounces) * std::min(worst, most_of_a_turn) : 0.0);
  }
  return errors;
}

std::vector<RayError> ray_errors(const EigenraySolver& solver, double source_depth,
                                 double receiver_depth, double frequency, const PathLimits& limits,
                                 const Arrivals& rays) {
  const std::vector<double> focusing = focusing_errors(solver, source_depth, receiver_depth,
                                                       frequency, limits, rays, faintest_focus);
  const std::vector<double> turning = corner_errors(solver.environment(), frequency, rays, true);
  std::vector<RayError> errors;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool mended = rays[i].kind == ArrivalKind::caustic;
    errors.push_back({.focusing = mended ? std::min(focusing[i], of_a_caustic) : focusing[i],
                      .turning = turning[i]});
  }
  return errors;
}

}  // namespace asdic::detail
