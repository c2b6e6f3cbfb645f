#include "raytrace/waves/ray_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "raytrace/math/integer_power.h"
#include "raytrace/waves/focus.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double faintest_focus = 1e-4;        // of the rays' energy
constexpr double most_of_a_turn = 1.5;         // [rad]
constexpr double widest_turn = radians(10.0);  // about a ray that is looked at
constexpr double of_a_caustic = 0.1;           // what a pair's amplitudes may be off by at most

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

/// A boundary as it is at the source, for rays of a slowness.
struct FlatWall {
  const BoundaryMaterial& material;
  WaterAtBoundary water;

  FlatWall(const Environment& ocean, const Boundary& boundary, double frequency)
      : material(boundary.material_at(0.0)),
        water{.speed = sound_speed(ocean, 0.0, boundary.depth_at(0.0)).c,
              .density = ocean.water_density.at(boundary.depth_at(0.0)),
              .frequency = frequency} {}

  /// Reflection of all bounces at an angle [rad]; negative angles continue it as a straight line.
  [[nodiscard]] Complex at(double grazing, int bounces) const {
    const auto r = [&](double angle) {
      return integer_power(reflection_coefficient(material, std::min(angle, 0.5 * pi), water),
                           bounces);
    };
    return grazing < 0.0 ? 2.0 * r(0.0) - r(-grazing) : r(grazing);
  }
  [[nodiscard]] double grazing_of(double slowness) const {
    return std::acos(std::min(1.0, slowness * water.speed));
  }
};

/// F of a wall at either side of a ray, and at it. \param zone  of ξ [1/m]
std::array<Complex, 3> beside(const FlatWall& wall, const Arrival& ray, int bounces, double zone) {
  if (bounces == 0) return {1.0, 1.0, 1.0};
  const double angle = wall.grazing_of(ray.horizontal_slowness);
  const double turn = zone * wall.water.speed / (2.0 * pi * wall.water.frequency * std::sin(angle));
  const double step = turn < widest_turn ? turn : widest_turn;
  return {wall.at(angle + step, bounces), wall.at(angle - step, bounces), wall.at(angle, bounces)};
}

}  // namespace

double fresnel_zone(const Arrival& ray, double wavenumber) noexcept {
  const double sines = std::abs(std::sin(ray.launch_elevation) * std::sin(ray.arrival_elevation));
  return std::sqrt(2.0 * wavenumber * sines / std::max(std::abs(ray.q), 1e-9));
}

std::vector<double> reflection_errors(const Environment& ocean, double source_depth,
                                      double frequency, const Arrivals& rays) {
  constexpr double most = 4.0;  // of the difference: any phases
  const FlatWall surface(ocean, ocean.surface, frequency), bottom(ocean, ocean.bottom, frequency);
  const double k = 2.0 * pi * frequency / sound_speed(ocean, 0.0, source_depth).c;
  std::vector<double> errors;
  for (const Arrival& ray : rays) {
    errors.push_back(0.0);
    const bool judged = ray.kind != ArrivalKind::diffracted && std::norm(ray.amplitude) > 0.0;
    if (!judged || ray.surface_bounces + ray.bottom_bounces == 0) continue;
    const double zone = fresnel_zone(ray, k);
    const auto s = beside(surface, ray, ray.surface_bounces, zone),
               b = beside(bottom, ray, ray.bottom_bounces, zone);
    const double bend = std::abs(s[0] * b[0] + s[1] * b[1] - 2.0 * s[2] * b[2]);
    errors.back() = 0.25 * std::min(bend, most) / std::abs(s[2] * b[2]);
  }
  return errors;
}

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
  const std::vector<double> reflecting =
      reflection_errors(solver.environment(), source_depth, frequency, rays);
  std::vector<RayError> errors;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool mended = rays[i].kind == ArrivalKind::caustic;
    errors.push_back({.focusing = mended ? std::min(focusing[i], of_a_caustic) : focusing[i],
                      .turning = turning[i],
                      .reflecting = reflecting[i]});
  }
  return errors;
}

}  // namespace asdic::detail
