#include "raytrace/ocean/environment.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace asdic::detail {
namespace {

const double decibels_per_neper = 20.0 / std::log(10.0);

/// Loss just above and just below (at) a depth [dB/km].
struct Loss {
  double above, below;
};

Loss loss_at(const Environment& ocean, double law, double frequency, double depth) {
  Loss loss{law + ocean.attenuation_db_per_km.just_above(depth),
            law + ocean.attenuation_db_per_km.at(depth)};
  for (const BiologicalLayer& layer : ocean.biology) {
    const double taken = absorption_db_per_km(layer, frequency);
    if (depth > layer.top && depth <= layer.bottom) loss.above += taken;
    if (depth >= layer.top && depth < layer.bottom) loss.below += taken;
  }
  return loss;
}

}  // namespace

const BoundaryMaterial& Boundary::material_at(double range) const noexcept {
  if (!shape || shape->materials().empty()) return material;
  const std::size_t facet = shape->facet(range);
  return shape->materials()[facet == 0 ? 0 : facet - 1];
}

SoundSpeed2D sound_speed(const Environment& environment, double range, double depth) noexcept {
  if (environment.section) return environment.section->at(range, depth);
  const SoundSpeed water = environment.water.at(depth);
  return {.c = water.c, .c_z = water.dc_dz, .c_zz = water.d2c_dz2};
}

DepthFunction attenuation_np_per_m(const Environment& environment, double frequency) {
  const double per_km = 1e-3 / decibels_per_neper;  // Np/m in one dB/km
  const double law = absorption_db_per_km(environment.absorption, frequency);

  std::vector<double> places(environment.attenuation_db_per_km.depths().begin(),
                             environment.attenuation_db_per_km.depths().end());
  for (const BiologicalLayer& layer : environment.biology) {
    places.push_back(layer.top);
    places.push_back(layer.bottom);
  }
  if (places.empty()) return per_km * (law + environment.attenuation_db_per_km.at(0.0));
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());

  std::vector<double> depth, value;
  for (const double place : places) {
    const Loss loss = loss_at(environment, law, frequency, place);
    if (loss.above != loss.below) {
      depth.push_back(place);
      value.push_back(per_km * loss.above);
    }
    depth.push_back(place);
    value.push_back(per_km * loss.below);
  }
  return DepthFunction::table(depth, value);
}

bool varies_with_range(const Environment& environment) noexcept {
  return environment.section || environment.surface.shape || environment.bottom.shape;
}

Spreading spreading_across(const Environment& environment) noexcept {
  return varies_with_range(environment) ? environment.spreading : Spreading::cylindrical;
}

bool is_layered(const Environment& environment) noexcept {
  return !varies_with_range(environment) && environment.biology.empty() &&
         environment.attenuation_db_per_km.is_constant();
}

}  // namespace asdic::detail
