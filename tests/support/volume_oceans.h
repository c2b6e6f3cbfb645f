#pragma once
// Oceans in three dimensions whose rays are known, or known well enough.
#include <cmath>

#include "raytrace/ocean/sound_speed.h"
#include "raytrace/volume/volume_ocean.h"

namespace asdic::detail::support {

/// Uniform water over a plane floor that sinks along a bearing: a wedge whose apex line runs
/// through the origin.
class PlaneWedge : public VolumeOcean {
 public:
  PlaneWedge(double angle, double downhill_bearing, BoundaryMaterial floor, double c = 1500.0)
      : slope_(std::tan(angle)), bearing_(downhill_bearing), floor_(std::move(floor)), c_(c) {}

  WaterCell water_cell(const Vec3&, const Vec3&) const override { return {.uniform = true}; }
  VolumeSpeed speed(const Vec3&, std::size_t) const override { return {.c = c_}; }
  VolumeFloor floor(double x, double y) const override {
    const Vec2 down = slope_ * Vec2(std::sin(bearing_), std::cos(bearing_));
    return {.depth = down.x() * x + down.y() * y, .gradient = down};
  }
  const BoundaryMaterial& floor_material(double, double) const override { return floor_; }
  double floor_spacing() const override { return infinity; }
  double shallowest_floor() const override { return -infinity; }
  double deepest_floor() const override { return infinity; }
  double steepest_floor() const override { return slope_; }
  double water_density(double) const override { return 1000.0; }

  /// A place by its distance from the apex line, along that line (to the right of downhill), and
  /// the angle below the surface as seen from the line.
  Vec3 place(double distance, double angle, double along) const {
    const double out = distance * std::cos(angle);
    return {out * std::sin(bearing_) + along * std::cos(bearing_),
            out * std::cos(bearing_) - along * std::sin(bearing_), distance * std::sin(angle)};
  }

 private:
  double slope_, bearing_;
  BoundaryMaterial floor_;
  double c_;
};

/// Water of any profile over a floor of any law.
template <class Floor>
class ProfiledVolume : public VolumeOcean {
 public:
  ProfiledVolume(SoundSpeedProfile water, Floor floor, double shallowest, double deepest,
                 double steepest, double spacing, BoundaryMaterial material = Rigid{})
      : water_(std::move(water)),
        floor_(std::move(floor)),
        shallowest_(shallowest),
        deepest_(deepest),
        steepest_(steepest),
        spacing_(spacing),
        material_(std::move(material)) {}

  VolumeSpeed speed(const Vec3& place, std::size_t) const override {
    const SoundSpeed at = water_.at(place.z());
    VolumeSpeed speed{.c = at.c, .gradient = {0.0, 0.0, at.dc_dz}};
    speed.hessian(2, 2) = at.d2c_dz2;
    return speed;
  }
  VolumeFloor floor(double x, double y) const override { return floor_(x, y); }
  const BoundaryMaterial& floor_material(double, double) const override { return material_; }
  double floor_spacing() const override { return spacing_; }
  double shallowest_floor() const override { return shallowest_; }
  double deepest_floor() const override { return deepest_; }
  double steepest_floor() const override { return steepest_; }

 private:
  SoundSpeedProfile water_;
  Floor floor_;
  double shallowest_, deepest_, steepest_, spacing_;
  BoundaryMaterial material_;
};

}  // namespace asdic::detail::support
