#pragma once
#include <memory>

#include "raytrace/area/area.h"
#include "raytrace/volume/floor_blocks.h"
#include "raytrace/volume/transect_volume.h"

namespace asdic::detail {

/// An ocean over a map, in three dimensions. Water by a map is one smooth law. Land is a film of
/// water over a floor that reflects nothing, as in the planes of Area::section().
class AreaVolume : public VolumeOcean {
 public:
  static constexpr double measured = 50e3;  ///< about the map's [0, 0] [m]

  /// Bounds of slopes and of the water's gradient are those on the lines of the grid about the
  /// map's [0, 0], to `measured` at most, and a half more.
  explicit AreaVolume(std::shared_ptr<const Area> area);

  [[nodiscard]] WaterCell water_cell(const Vec3& place, const Vec3& towards) const override;
  [[nodiscard]] VolumeSpeed speed(const Vec3& place, std::size_t cell) const override;
  [[nodiscard]] double sideways_bending() const override { return bending_; }
  [[nodiscard]] double surface_depth() const override { return area_->surface_depth(); }
  [[nodiscard]] const BoundaryMaterial& surface_material() const override {
    return area_->everywhere().surface.material;
  }
  [[nodiscard]] const Roughness& surface_roughness() const override {
    return area_->everywhere().surface.roughness;
  }
  [[nodiscard]] VolumeFloor floor(double x, double y) const override;
  [[nodiscard]] const BoundaryMaterial& floor_material(double x, double y) const override {
    return area_->material_at(x, y);
  }
  [[nodiscard]] const Roughness& floor_roughness() const override {
    return area_->everywhere().bottom.roughness;
  }
  [[nodiscard]] double floor_spacing() const override { return area_->spacing(Vec2::Zero()); }
  [[nodiscard]] double shallowest_floor() const override { return -infinity; }
  [[nodiscard]] double deepest_floor() const override { return infinity; }
  [[nodiscard]] double steepest_floor() const override { return steepest_; }
  [[nodiscard]] double shallowest_within(const Vec2& low, const Vec2& high) const override {
    return blocks_.shallowest(low, high);
  }
  [[nodiscard]] double deepest_known() const override { return deepest_; }
  [[nodiscard]] double water_density(double depth) const override {
    return area_->everywhere().water_density.at(depth);
  }
  [[nodiscard]] DepthFunction attenuation(double frequency) const override {
    return attenuation_np_per_m(area_->everywhere(), frequency);
  }

 private:
  std::shared_ptr<const Area> area_;
  TransectVolume column_;  // of water that is everywhere the same
  FloorBlocks blocks_;
  double bending_ = 0.0, steepest_ = 0.0, deepest_ = 0.0;
};

}  // namespace asdic::detail
