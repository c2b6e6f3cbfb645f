#include "raytrace/volume/transect_volume.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace asdic::detail {
namespace {

/// The interval of an axis that a place lies in, walls and all: beyond its ends the outer one.
/// \param step  which way it goes on: on a wall it is in what comes next
std::size_t interval_ahead(std::span<const double> axis, double place, double step) {
  constexpr double on_wall = 1e-6;  // [m]
  const double at = place + std::copysign(on_wall, step);
  return static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), at) - axis.begin());
}

/// Walls of such an interval.
WaterSlab slab_of(std::span<const double> axis, std::size_t interval, const Vec3& normal,
                  double origin) {
  return {.normal = normal,
          .low = interval == 0 ? -infinity : axis[interval - 1] + origin,
          .high = interval >= axis.size() ? infinity : axis[interval] + origin};
}

}  // namespace

TransectVolume::TransectVolume(const Environment& environment, const Transect& transect)
    : environment_(environment),
      transect_(transect),
      along_(std::sin(transect.bearing), std::cos(transect.bearing), 0.0) {
  if (environment.surface.shape)
    throw InputError({.where = "environment.surface.shape",
                      .got = "a surface that is not flat",
                      .expected = "a flat one: rays in three dimensions know no other "
                                  "(propagation.dimension = 2 does)"});
  measure_floor();
  measure_water();
}

void TransectVolume::measure_floor() {
  const Boundary& bottom = environment_.bottom;
  shallowest_ = deepest_ = bottom.depth;
  if (!bottom.shape) return;
  const BoundaryShape& shape = *bottom.shape;
  shallowest_ = shape.shallowest();
  deepest_ = shape.deepest();
  faceted_ = shape.interpolation() == ShapeInterpolation::piecewise_linear;
  const auto ranges = shape.ranges();
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    spacing_ = std::min(spacing_, ranges[i] - ranges[i - 1]);
    constexpr int parts = 32;
    for (int k = 0; k <= parts; ++k) {
      const double r = ranges[i - 1] + (ranges[i] - ranges[i - 1]) * double(k) / parts;
      steepest_ = std::max(steepest_, std::abs(shape.at(r, i).slope));
    }
  }
  steepest_ *= 1.01;  // between those places
}

void TransectVolume::measure_water() {
  if (environment_.section) {
    const SoundSpeedSection& section = *environment_.section;
    const auto ranges = section.ranges();
    const auto speeds = section.speeds();
    const std::size_t depths = section.depths().size();
    const double slowest = *std::min_element(speeds.begin(), speeds.end());
    for (std::size_t i = 1; i < ranges.size(); ++i)
      for (std::size_t j = 0; j < depths; ++j)
        bending_ =
            std::max(bending_, std::abs(speeds[i * depths + j] - speeds[(i - 1) * depths + j]) /
                                   (ranges[i] - ranges[i - 1]) / (slowest * slowest));
    return;
  }
  const SoundSpeedProfile& water = environment_.water;
  if (water.munk_parameters()) return;
  const auto speeds = water.speeds();
  uniform_ = std::all_of(speeds.begin(), speeds.end(), [&](double c) { return c == speeds[0]; });
  layers_ = !uniform_ && (water.interpolation() == Interpolation::c_linear ||
                          water.interpolation() == Interpolation::n2_linear);
}

WaterCell TransectVolume::water_cell(const Vec3& place, const Vec3& towards) const {
  if (uniform_) return {.index = 0, .uniform = true, .slabs = {}, .walls = 0};
  if (environment_.section) {
    const SoundSpeedSection& section = *environment_.section;
    const auto inner = section.depths().subspan(1, section.depths().size() - 2);
    const std::size_t row = interval_ahead(inner, place.z(), towards.z());
    const double origin = along_.x() * transect_.x + along_.y() * transect_.y;
    const std::size_t column =
        interval_ahead(section.ranges(), along_.dot(place) - origin, along_.dot(towards));
    return {.index = column * (inner.size() + 1) + row,
            .uniform = false,
            .slabs = {slab_of(inner, row, Vec3::UnitZ(), 0.0),
                      slab_of(section.ranges(), column, along_, origin)},
            .walls = 2};
  }
  if (!layers_) return {};
  const auto depths = environment_.water.depths();
  const auto inner = depths.subspan(1, depths.size() - 2);
  const std::size_t layer = interval_ahead(inner, place.z(), towards.z());
  return {.index = layer,
          .uniform = false,
          .slabs = {slab_of(inner, layer, Vec3::UnitZ(), 0.0)},
          .walls = 1};
}

VolumeSpeed TransectVolume::speed(const Vec3& place, std::size_t cell) const {
  if (environment_.section) {
    const SoundSpeedSection& section = *environment_.section;
    const std::size_t rows = section.depths().size() - 1;
    const SoundSpeed2D at =
        section.at(transect_.range_of(place.x(), place.y()), place.z(),
                   SoundSpeedSection::Cell{.column = cell / rows, .row = cell % rows});
    VolumeSpeed speed{.c = at.c, .gradient = at.c_r * along_};
    speed.gradient.z() = at.c_z;
    speed.hessian = at.c_rr * along_ * along_.transpose();
    for (int i = 0; i < 2; ++i) speed.hessian(i, 2) = speed.hessian(2, i) = at.c_rz * along_[i];
    speed.hessian(2, 2) = at.c_zz;
    return speed;
  }
  const SoundSpeed at =
      layers_ ? environment_.water.at(place.z(), cell) : environment_.water.at(place.z());
  VolumeSpeed speed{.c = at.c, .gradient = {0.0, 0.0, at.dc_dz}};
  speed.hessian(2, 2) = at.d2c_dz2;
  return speed;
}

VolumeFloor TransectVolume::floor(double x, double y) const {
  const Boundary& bottom = environment_.bottom;
  if (!bottom.shape) return {.depth = bottom.depth};
  const double range = transect_.range_of(x, y);
  const std::size_t facet = bottom.shape->facet(range);
  const BoundaryPoint at = bottom.shape->at(range, facet);
  const double steep = 1.0 + at.slope * at.slope;
  const Vec2 along(along_.x(), along_.y());
  return {.depth = at.depth,
          .gradient = at.slope * along,
          .hessian = at.curvature * steep * std::sqrt(steep) * along * along.transpose(),
          .facet = faceted_ ? facet : 0};
}

const BoundaryMaterial& TransectVolume::floor_material(double x, double y) const {
  return environment_.bottom.material_at(transect_.range_of(x, y));
}

}  // namespace asdic::detail
