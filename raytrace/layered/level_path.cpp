#include "raytrace/layered/level_path.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/units.h"
#include "raytrace/ocean/level_rays.h"
#include "raytrace/ocean/tube_amplitude.h"

namespace asdic::detail {
namespace {

/// A ray that is nearly level along its whole path, to first order in its angle. Its depth z obeys
/// d²z/dr² = −c′/c, where c′ is linear in depth.
struct FlatRay {
  double launch = 0.0, arrival = 0.0;  ///< dz/dr at its ends
  double q = 0.0;                      ///< dz/d(launch): sin(kr)/k, k² = c″/c [m]
  double later = 0.0;                  ///< delay beyond that of the level ray, to second order [s]
  int caustics = 0;                    ///< zeros of q along the path
};

/// Whether a profile, at the depth `there`, is the parabola about `depth` to a share of its bend.
bool is_parabola(const SoundSpeedProfile& water, double depth, double there, double share) {
  const SoundSpeed here = water.at(depth), other = water.at(there);
  const double away = there - depth, bend = 0.5 * here.d2c_dz2 * away * away;
  return std::abs(other.d2c_dz2 - here.d2c_dz2) <= share * std::abs(here.d2c_dz2) &&
         std::abs(other.c - here.c - here.dc_dz * away - bend) <=
             share * std::abs(bend) + 1e-13 * here.c;
}

/// The flat ray between two depths beside an extremum of c, or where c has no gradient; none where
/// it is steep enough for the search of r(σ) to resolve.
std::optional<FlatRay> flat_ray(const SoundSpeedProfile& water, double source_depth,
                                double receiver_depth, double range) {
  const SoundSpeed here = water.at(source_depth);
  const double bend = here.d2c_dz2 / here.c, k = std::sqrt(std::abs(bend)), x = k * range;
  // c′ so small that the extremum is near
  if (std::abs(here.dc_dz) > flattest * k * here.c) return std::nullopt;
  const bool straight = k == 0.0, minimum = bend > 0.0;
  const double half = minimum ? std::sin(0.5 * x) : std::sinh(0.5 * x);
  const double cosine = minimum ? std::cos(x) : std::cosh(x);
  FlatRay ray{.q = straight ? range : (minimum ? std::sin(x) : std::sinh(x)) / k,
              .caustics = minimum ? static_cast<int>(x / pi) : 0};
  const double fall = here.dc_dz / here.c;
  const double apart = receiver_depth - source_depth;
  ray.launch = (apart + (straight ? 0.0 : 2.0 * fall * half * half / (k * k))) / ray.q;
  ray.arrival = ray.launch * cosine - fall * ray.q;
  const double steepest = std::max(std::abs(ray.launch), std::abs(ray.arrival));
  if (!(steepest < (straight ? flattest_straight : flattest))) return std::nullopt;
  // Depth of the extremum under the source's.
  const double axis = straight ? 0.0 : -fall / bend;
  ray.later =
      0.5 / here.c * ((apart - axis) * ray.arrival + axis * ray.launch - fall * axis * range);
  // The error of the parabola is one order higher in the distance from the axis. Beside a focus,
  // where q = 0, that order is all that spreads the rays, so there the parabola has to hold better.
  const double share = 0.01 * std::min(1.0, std::abs(ray.q) / std::min(range, 1.0 / k));
  const double away = straight ? 0.0 : std::abs(axis) + steepest / k;  // largest distance from it
  for (const double there : {receiver_depth, 0.5 * (source_depth + receiver_depth),
                             source_depth - away, source_depth + away})
    if (there != source_depth && !is_parabola(water, source_depth, there, share))
      return std::nullopt;
  return ray;
}

Arrival path_of(const FlatRay& ray, const Environment& ocean, double depth, double range,
                double frequency) {
  const double c = ocean.water.at(depth).c;
  Arrival path;
  path.launch_elevation = 0.0 - ray.launch;  // 0 and not −0
  path.arrival_elevation = 0.0 - ray.arrival;
  path.q = ray.q;
  path.caustics = ray.caustics;
  path.delay = range / c + ray.later;
  path.path_length = range;
  path.horizontal_slowness = 1.0 / c;
  path.spreading = tube_amplitude(
      Spreading::cylindrical,
      {.speed = c, .q = path.q, .range = range, .launch_slowness = path.horizontal_slowness});
  path.absorption_db =
      1e-3 *
      (absorption_db_per_km(ocean.absorption, frequency) + ocean.attenuation_db_per_km.at(0.0)) *
      range;
  path.amplitude = path_amplitude(path.spreading, amplitude_from_db(-path.absorption_db),
                                  path.reflection, path.caustics);
  return path;
}

/// The rays that are one path for a receiver at this depth; none if it is not near the source's.
LevelRays level_at(const Environment& ocean, double frequency, double source_depth,
                   double receiver_depth) {
  const double apart = std::abs(source_depth - receiver_depth);
  constexpr double furthest = 1000.0;  // LevelRays::height is c/4f
  if (apart * frequency > furthest) return {};
  const LevelRays level = level_paths(ocean, frequency, 0.0, source_depth);
  return apart <= level.height ? level : LevelRays{};
}

}  // namespace

bool is_flat(const Arrival& path, const SoundSpeed& at_source) noexcept {
  const double most = at_source.d2c_dz2 == 0.0 ? flattest_straight : flattest;
  return path.bounces.empty() && std::abs(path.launch_elevation) < most &&
         std::abs(path.arrival_elevation) < most;
}

void put_level_paths(const Environment& ocean, double frequency, double source_depth,
                     double receiver_depth, std::span<const double> ranges,
                     std::vector<Arrivals>& found) {
  const LevelRays kink = level_at(ocean, frequency, source_depth, receiver_depth);
  // Near a smooth extremum of c, rays as flat as this are the level ray itself up to rounding.
  constexpr double unresolved = 2.0 * flattest;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!(ranges[i] > 0.0)) continue;
    const auto flat = flat_ray(ocean.water, source_depth, receiver_depth, ranges[i]);
    if (!flat && kink.angle == 0.0) continue;
    const double angle = flat ? unresolved : kink.angle;
    std::erase_if(found[i], [&](const Arrival& a) {
      return a.bounces.empty() && std::abs(a.launch_elevation) < angle &&
             std::abs(a.arrival_elevation) < angle;
    });
    found[i].push_back(
        path_of(flat.value_or(FlatRay{.q = ranges[i]}), ocean, source_depth, ranges[i], frequency));
    std::sort(found[i].begin(), found[i].end(), earlier);
  }
}

}  // namespace asdic::detail
