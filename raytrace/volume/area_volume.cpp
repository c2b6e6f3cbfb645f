#include "raytrace/volume/area_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace asdic::detail {
namespace {

constexpr double more = 1.5;  // than what was measured on lines

}  // namespace

AreaVolume::AreaVolume(std::shared_ptr<const Area> area)
    : area_(std::move(area)),
      column_(area_->everywhere(), area_->transect()),
      blocks_(area_->floor(), area_->surface_depth() + Area::film) {
  const auto look = [](double step, double most_lines, const auto& at) {
    const int lines = static_cast<int>(std::min(most_lines, measured / step));
    for (int i = -lines; i <= lines; ++i)
      for (int j = -lines; j <= lines; ++j) at(i * step, j * step);
  };
  look(std::max(area_->spacing(Vec2::Zero()), measured / 150.0), 150.0, [&](double x, double y) {
    if (!area_->floor().covers(x, y)) return;
    const VolumeFloor here = floor(x, y);
    steepest_ = std::max(steepest_, here.gradient.norm());
    deepest_ = std::max(deepest_, here.depth);
  });
  steepest_ *= more;
  if (!area_->water()) {
    bending_ = column_.sideways_bending();
    return;
  }
  const WaterMap& water = *area_->water();
  look(std::max(water.spacing(0.0, 0.0), measured / 10.0), 10.0, [&](double x, double y) {
    if (!water.covers(x, y) || area_->is_land(x, y)) return;
    for (const double z : water.depths().places()) {
      const SoundSpeed3D c = water.at(x, y, z);
      bending_ = std::max(bending_, std::hypot(c.c_x, c.c_y) / (c.c * c.c));
    }
  });
  bending_ *= more;
}

WaterCell AreaVolume::water_cell(const Vec3& place, const Vec3& towards) const {
  if (area_->water()) return {};
  return column_.water_cell(place, towards);
}

VolumeSpeed AreaVolume::speed(const Vec3& place, std::size_t cell) const {
  if (!area_->water()) return column_.speed(place, cell);
  const SoundSpeed3D c = area_->water()->at(place.x(), place.y(), place.z());
  VolumeSpeed speed{.c = c.c, .gradient = {c.c_x, c.c_y, c.c_z}};
  speed.hessian << c.c_xx, c.c_xy, c.c_xz,  //
      c.c_xy, c.c_yy, c.c_yz,               //
      c.c_xz, c.c_yz, c.c_zz;
  return speed;
}

VolumeFloor AreaVolume::floor(double x, double y) const {
  const MapValue depth = area_->floor().at(x, y);
  const double land = area_->surface_depth() + Area::film;  // as Area::is_land()
  if (depth.value <= land) return {.depth = land};
  VolumeFloor floor{.depth = depth.value, .gradient = {depth.x, depth.y}};
  if (area_->floor().interpolation() == MapInterpolation::faceted) {
    floor.facet = 1 + area_->floor().facet(x, y);
    return floor;
  }
  floor.hessian << depth.xx, depth.xy, depth.xy, depth.yy;
  return floor;
}

}  // namespace asdic::detail
