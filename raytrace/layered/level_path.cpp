#include "raytrace/layered/level_path.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/level_rays.h"
#include "raytrace/ocean/tube_amplitude.h"

namespace asdic::detail {
namespace {

/// The ray along a depth where the speed has no gradient, which r(σ) cannot tell: it stays there,
/// and its beam obeys d²q/dr² = −(c″/c)·q.
Arrival horizontal_ray(const Environment& ocean, double depth, double range, double frequency) {
  const SoundSpeed water = ocean.water.at(depth);
  // q = sin(kr)/k about a minimum of c, sinh(kr)/k about a maximum
  // (on a kink it is straight: k = 0)
  const double k = water.dc_dz == 0.0 ? std::sqrt(std::abs(water.d2c_dz2) / water.c) : 0.0;
  Arrival path;
  path.q = k * range < 1e-6
               ? range
               : (water.d2c_dz2 > 0.0 ? std::sin(k * range) : std::sinh(k * range)) / k;
  path.caustics = water.d2c_dz2 > 0.0 ? static_cast<int>(k * range / pi) : 0;
  path.delay = range / water.c;
  path.path_length = range;
  path.horizontal_slowness = 1.0 / water.c;
  path.spreading = tube_amplitude(
      Spreading::cylindrical,
      {.speed = water.c, .q = path.q, .range = range, .launch_slowness = path.horizontal_slowness});
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

void put_level_paths(const Environment& ocean, double frequency, double source_depth,
                     double receiver_depth, std::span<const double> ranges,
                     std::vector<Arrivals>& found) {
  // Of a smooth extremum of c rays that stay within centimetres of the level are the level one,
  // seen through rounding.
  const bool smooth = source_depth == receiver_depth && ocean.water.at(source_depth).dc_dz == 0.0;
  const LevelRays level =
      smooth ? LevelRays{.angle = 1e-5} : level_at(ocean, frequency, source_depth, receiver_depth);
  if (level.angle == 0.0) return;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!(ranges[i] > 0.0)) continue;
    found[i].push_back(horizontal_ray(ocean, source_depth, ranges[i], frequency));
    if (smooth)
      std::erase_if(found[i], [&](const Arrival& a) {
        return a.launch_elevation != 0.0 && std::abs(a.launch_elevation) < level.angle;
      });
    else
      merge_level_paths(level, found[i]);
    std::sort(found[i].begin(), found[i].end(), earlier);
  }
}

}  // namespace asdic::detail
