#include "raytrace/volume/volume_ocean.h"

namespace asdic::detail {

WaterCell VolumeOcean::water_cell(const Vec3& /*place*/, const Vec3& /*towards*/) const {
  return {};
}

VolumeSpeed VolumeOcean::speed_at(const Vec3& place) const {
  return speed(place, water_cell(place, Vec3::UnitZ()).index);
}

const BoundaryMaterial& VolumeOcean::surface_material() const {
  static const BoundaryMaterial air = Vacuum{};
  return air;
}

const Roughness& VolumeOcean::surface_roughness() const {
  static const Roughness smooth;
  return smooth;
}

const Roughness& VolumeOcean::floor_roughness() const {
  static const Roughness smooth;
  return smooth;
}

double VolumeOcean::shallowest_within(const Vec2& /*low*/, const Vec2& /*high*/) const {
  return shallowest_floor();
}

double VolumeOcean::water_density(double /*depth*/) const { return 1027.0; }

DepthFunction VolumeOcean::attenuation(double /*frequency*/) const { return 0.0; }

}  // namespace asdic::detail
