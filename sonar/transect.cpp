#include "sonar/transect.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace asdic {
namespace {

/// s = (r − start)·scale, r the range along the transect, s along the plane; scale may be negative.
struct Stretch {
  double start, scale;

  [[nodiscard]] bool turns() const { return scale < 0.0; }
  [[nodiscard]] std::vector<double> of(std::span<const double> ranges) const {
    std::vector<double> stretched;
    for (const double r : ranges) stretched.push_back((r - start) * scale);
    if (turns()) std::reverse(stretched.begin(), stretched.end());
    return stretched;
  }
};

/// The same sequence, or backwards when the plane runs against the transect.
template <class Value>
std::vector<Value> ordered(std::span<const Value> values, bool backwards) {
  std::vector<Value> result(values.begin(), values.end());
  if (backwards) std::reverse(result.begin(), result.end());
  return result;
}

BoundaryShape stretched(const BoundaryShape& shape, const Stretch& stretch) {
  auto materials = ordered(shape.materials(), false);
  if (stretch.turns() && !materials.empty()) {
    // Material i lies from node i to node i + 1, the first also before, the last beyond. Backwards,
    // from node n−1−i to n−2−i: what was before the next node. What lay beyond the last node now
    // lies before the first, which can only have the material of its facet: the same there.
    std::reverse(materials.begin(), materials.end());
    std::rotate(materials.begin(), materials.begin() + 1, materials.end());
    materials.back() = shape.materials().front();
  }
  return {stretch.of(shape.ranges()), ordered(shape.depths(), stretch.turns()),
          shape.interpolation(), std::move(materials)};
}

SoundSpeedSection stretched(const SoundSpeedSection& section, const Stretch& stretch) {
  const std::size_t n = section.depths().size(), m = section.ranges().size();
  std::vector<double> speed;
  for (std::size_t i = 0; i < m; ++i) {
    const auto row = section.speeds().subspan((stretch.turns() ? m - 1 - i : i) * n, n);
    speed.insert(speed.end(), row.begin(), row.end());
  }
  return {stretch.of(section.ranges()), section.depths(), speed};
}

/// What a boundary is at one range, everywhere.
Boundary flat_at(const Boundary& boundary, double range) {
  return {.depth = boundary.depth_at(range), .material = boundary.material_at(range)};
}

}  // namespace

double Transect::range_of(double east, double north) const noexcept {
  return (east - x) * std::sin(bearing) + (north - y) * std::cos(bearing);
}

Environment ocean_along(const Environment& ocean, const Transect& transect, double east,
                        double north, double bearing) {
  if (!ocean.section && !ocean.surface.shape && !ocean.bottom.shape) return ocean;
  Environment plane = ocean;
  const double start = transect.range_of(east, north);
  const double along = std::cos(bearing - transect.bearing);
  std::vector<double> here;
  if (ocean.section) {
    for (const double z : ocean.section->depths()) here.push_back(ocean.section->at(start, z).c);
    plane.water = SoundSpeedProfile::table(ocean.section->depths(), here, Interpolation::c_linear);
  }
  // Closer to the perpendicular than this, range changes by 1 mm in 1000 km.
  constexpr double across = 1e-9;
  if (std::abs(along) < across) {
    plane.section.reset();
    plane.surface = flat_at(ocean.surface, start);
    plane.bottom = flat_at(ocean.bottom, start);
    return plane;
  }
  const Stretch stretch{.start = start, .scale = 1.0 / along};
  if (ocean.section) plane.section = stretched(*ocean.section, stretch);
  for (Boundary* boundary : {&plane.surface, &plane.bottom}) {
    if (!boundary->shape) continue;
    boundary->shape = stretched(*boundary->shape, stretch);
    boundary->depth = boundary->shape->depth_at(0.0);
    boundary->material = boundary->material_at(0.0);
  }
  return plane;
}

}  // namespace asdic
