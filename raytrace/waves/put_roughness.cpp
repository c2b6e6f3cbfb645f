#include "raytrace/waves/put_roughness.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace asdic::detail {
namespace {

/// Multiplies what a path's bounces off one boundary leave.
void reflect(const Boundary& boundary, double speed, double frequency, double slowness, int bounces,
             RoughReflection& left) {
  if (boundary.roughness.smooth() || bounces == 0) return;
  const double cosine = std::min(slowness * speed, 1.0);
  const RoughReflection one = rough_reflection(
      boundary.roughness, std::sqrt((1.0 - cosine) * (1.0 + cosine)), 2.0 * pi * frequency / speed);
  left.coherent *= std::pow(one.coherent, bounces);
  left.energy *= std::pow(one.energy, bounces);
}

}  // namespace

bool is_rough(const Environment& ocean) noexcept {
  return !(ocean.surface.roughness.smooth() && ocean.bottom.roughness.smooth());
}

Environment without_roughness(Environment ocean) {
  ocean.surface.roughness = ocean.bottom.roughness = {};
  return ocean;
}

void put_roughness(const Environment& ocean, double frequency, double faintest, Arrivals& paths) {
  const double c_surface = ocean.water.at(ocean.surface.depth).c,
               c_bottom = ocean.water.at(ocean.bottom.depth).c;
  std::erase_if(paths, [&](Arrival& path) {
    RoughReflection left;
    reflect(ocean.surface, c_surface, frequency, path.horizontal_slowness, path.surface_bounces,
            left);
    reflect(ocean.bottom, c_bottom, frequency, path.horizontal_slowness, path.bottom_bounces, left);
    if (std::norm(path.reflection) * left.energy < faintest * faintest) return true;
    path.scattered =
        std::norm(path.amplitude) * std::max(0.0, left.energy - left.coherent * left.coherent);
    path.amplitude *= left.coherent;
    path.reflection *= left.coherent;
    return false;
  });
}

}  // namespace asdic::detail
