#include "raytrace/beams/beam.h"

#include <cmath>

#include "raytrace/beams/geometric.h"

namespace asdic {

double beams::launch_factor(const BeamSetting& setting, const BeamLaunch& launch) noexcept {
  return launch.amplitude *
         (setting.point_source ? std::sqrt(std::abs(std::cos(launch.elevation))) : 1.0);
}

void add_beam(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
              FieldSum& field) {
  switch (setting.kind) {
    case BeamKind::hat:
    case BeamKind::gaussian:
      return beams::add_cartesian(setting, launch, ray, field);
    case BeamKind::ray_centred_hat:
    case BeamKind::ray_centred_gaussian:
      return beams::add_ray_centred(setting, launch, ray, field);
    case BeamKind::simple_gaussian:
      return beams::add_simple_gaussian(setting, launch, ray, field);
    case BeamKind::cerveny_cartesian:
      return beams::add_cerveny_cartesian(setting, launch, ray, field);
    case BeamKind::cerveny_ray_centred:
      return beams::add_cerveny_ray_centred(setting, launch, ray, field);
  }
}

double field_scale(const BeamSetting& setting, double range) noexcept {
  if (!setting.point_source) return 4.0 * std::sqrt(pi);
  return range == 0.0 ? 0.0 : 1.0 / std::sqrt(std::abs(range));
}

}  // namespace asdic
