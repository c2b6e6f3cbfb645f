#pragma once
#include "raytrace/ocean/transect.h"
#include "raytrace/volume/volume_ocean.h"

namespace asdic::detail {

/// The ocean along a transect as the three-dimensional ocean that it stands for: it varies along
/// one bearing of the map and is the same across it.
class TransectVolume : public VolumeOcean {
 public:
  /// \throws InputError ("environment.surface.shape") if the surface is not flat
  TransectVolume(const Environment& environment, const Transect& transect);

  [[nodiscard]] WaterCell water_cell(const Vec3& place, const Vec3& towards) const override;
  [[nodiscard]] VolumeSpeed speed(const Vec3& place, std::size_t cell) const override;
  [[nodiscard]] double sideways_bending() const override { return bending_; }
  [[nodiscard]] double surface_depth() const override { return environment_.surface.depth; }
  [[nodiscard]] const BoundaryMaterial& surface_material() const override {
    return environment_.surface.material;
  }
  [[nodiscard]] const Roughness& surface_roughness() const override {
    return environment_.surface.roughness;
  }
  [[nodiscard]] VolumeFloor floor(double x, double y) const override;
  [[nodiscard]] const BoundaryMaterial& floor_material(double x, double y) const override;
  [[nodiscard]] const Roughness& floor_roughness() const override {
    return environment_.bottom.roughness;
  }
  [[nodiscard]] double floor_spacing() const override { return spacing_; }
  [[nodiscard]] double shallowest_floor() const override { return shallowest_; }
  [[nodiscard]] double deepest_floor() const override { return deepest_; }
  [[nodiscard]] double steepest_floor() const override { return steepest_; }
  [[nodiscard]] double water_density(double depth) const override {
    return environment_.water_density.at(depth);
  }
  [[nodiscard]] DepthFunction attenuation(double frequency) const override {
    return attenuation_np_per_m(environment_, frequency);
  }

 private:
  void measure_floor();
  void measure_water();

  Environment environment_;
  Transect transect_;
  Vec3 along_;            // unit vector of growing range
  bool uniform_ = false;  // one speed everywhere
  bool layers_ = false;   // the profile's gradient jumps at its samples
  bool faceted_ = false;  // the floor's slope jumps at its nodes
  double bending_ = 0.0;
  double spacing_ = infinity, shallowest_ = 0.0, deepest_ = 0.0, steepest_ = 0.0;
};

}  // namespace asdic::detail
