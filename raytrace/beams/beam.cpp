#include "raytrace/beams/beam.h"

#include <cmath>

#include "raytrace/beams/geometric.h"

namespace asdic::detail {

double beams::launch_factor(const BeamSetting& setting, const BeamLaunch& launch,
                            double source_speed) noexcept {
  if (!setting.point_source) return launch.amplitude;
  return launch.amplitude * std::sqrt(setting.spreading == Spreading::plane
                                          ? source_speed
                                          : std::abs(std::cos(launch.elevation)));
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
  if (range == 0.0) return 0.0;
  return setting.spreading == Spreading::plane ? 1.0 : 1.0 / std::sqrt(std::abs(range));
}

}  // namespace asdic::detail
