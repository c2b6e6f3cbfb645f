#include "raytrace/ocean/slice.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

/// |cos β| below which a line does not get along the transect.
constexpr double almost_across = 1e-9;

/// What a section says of one place: straight lines between the depths of its grid.
SoundSpeedProfile profile_at(const SoundSpeedSection& section, double x) {
  std::vector<double> speed;
  for (const double depth : section.depths()) speed.push_back(section.at(x, depth).c);
  return SoundSpeedProfile::table(section.depths(), speed, Interpolation::c_linear);
}

SoundSpeedSection section_along(const SoundSpeedSection& section, double x0, double cos_beta) {
  const std::size_t depths = section.depths().size(), ranges = section.ranges().size();
  std::vector<double> range, speed;
  speed.reserve(section.speeds().size());
  for (std::size_t i = 0; i < ranges; ++i) {
    const std::size_t from = cos_beta < 0.0 ? ranges - 1 - i : i;
    range.push_back((section.ranges()[from] - x0) / cos_beta);
    const auto row = section.speeds().subspan(from * depths, depths);
    speed.insert(speed.end(), row.begin(), row.end());
  }
  return {range, section.depths(), speed};
}

Boundary boundary_along(const Boundary& boundary, double x0, double cos_beta) {
  if (!boundary.shape) return boundary;
  if (std::abs(cos_beta) < almost_across)
    return {.depth = boundary.depth_at(x0),
            .material = boundary.material_at(x0),
            .shape = {},
            .roughness = boundary.roughness};
  return {.depth = boundary.depth_at(x0),
          .material = boundary.material,
          .shape = boundary.shape->along(x0, cos_beta),
          .roughness = boundary.roughness};
}

}  // namespace

Environment slice(const Environment& environment, double x0, double cos_beta) {
  if (x0 == 0.0 && cos_beta == 1.0) return environment;
  Environment plane = environment;
  plane.surface = boundary_along(environment.surface, x0, cos_beta);
  plane.bottom = boundary_along(environment.bottom, x0, cos_beta);
  if (environment.section) {
    plane.water = profile_at(*environment.section, x0);
    plane.section.reset();
    if (std::abs(cos_beta) >= almost_across)
      plane.section = section_along(*environment.section, x0, cos_beta);
  }
  return plane;
}

}  // namespace asdic::detail
