#include "raytrace/beams/ray_at_columns.h"

#include <cmath>

#include "core/simd.h"
#include "raytrace/beams/geometric.h"
#include "raytrace/beams/larger.h"

namespace asdic::detail {
namespace {

using beams::larger;
using beams::smaller;

}  // namespace

void RayAtColumns::resize(std::size_t n) {
  for (auto* array :
       {&size, &growth, &cosine, &higher, &amplitude, &power, &phase, &wave_number, &least})
    array->resize(n);
}

void RayAtColumns::foretell(const BeamSetting& setting, const BeamLaunch& launch) {
  const std::size_t n = crossings.size();
  resize(n);
  const double launched = beams::launch_factor(setting, launch, crossings.source_speed);
  const double launched2 = launched * launched / crossings.source_speed;
  const double f = setting.frequency, omega = 2.0 * pi * f;
  const bool coherent = setting.coherent;
  const double width = setting.kind == BeamKind::hat ? 0.0 : 1.0;
  const double *q = crossings.q.data(), *cos_in = crossings.cosine.data(),
               *sine = crossings.sine.data(), *dq_ds = crossings.dq_ds.data(),
               *c = crossings.speed.data(), *time = crossings.time.data(),
               *level = crossings.level.data(), *turned = crossings.phase.data(),
               *mirror = crossings.mirror.data();
  double *size_to = size.data(), *growth_to = growth.data(), *cosine_to = cosine.data(),
         *higher_to = higher.data(), *amplitude_to = amplitude.data(), *power_to = power.data(),
         *phase_to = phase.data(), *number_to = wave_number.data(), *least_to = least.data();
  ASDIC_INDEPENDENT
  for (std::size_t i = 0; i < n; ++i) {
    const double along = std::abs(cos_in[i]), sign = q[i] < 0.0 ? -1.0 : 1.0;
    const double intensity = launched2 * level[i] * level[i] * c[i];  // · |q|
    size_to[i] = larger(std::abs(q[i]), 1e-9);
    growth_to[i] = sign * dq_ds[i] * sine[i];
    cosine_to[i] = along;
    higher_to[i] = q[i] * cos_in[i] * mirror[i] > 0.0 ? -1.0 : 1.0;
    amplitude_to[i] = intensity / size_to[i];
    power_to[i] = intensity / along;
    phase_to[i] = turned[i] - omega * time[i];
    number_to[i] = -omega * sine[i] / c[i];
    least_to[i] = width * smaller(0.2 * f * time[i], pi * c[i] / f);
  }
  if (coherent)
    for (std::size_t i = 0; i < n; ++i) amplitude_to[i] = std::sqrt(amplitude_to[i]);
}

}  // namespace asdic::detail
