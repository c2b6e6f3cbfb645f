#include "io/scenario/materials/layered.h"

#include "core/quantities.h"
#include "io/scenario/materials/loss.h"

namespace asdic::detail::scenario {
namespace {

constexpr Quantity layer_thickness{.noun = "thickness", .unit = "m", .low = 0.0, .high = 1e4};

/// What is known of a layer but its thickness; with shear_speed above 0 it is a solid.
void describe_waves(Fields& field, FloorLayer& layer) {
  field("speed", layer.speed, quantity::sound_speed, "of compressional waves");
  field("density", layer.density, quantity::density, "of it");
  describe_loss(field, false, layer.speed, layer.attenuation_db_per_wavelength);
  field("shear_speed", layer.shear_speed, shear_speed_quantity, "of shear waves; 0: a fluid");
  describe_loss(field, true, layer.shear_speed, layer.shear_attenuation_db_per_wavelength);
  if (!field.checks()) return;
  // A wave that gives no energy back, whatever squeezes or shears the layer.
  const double shear =
      4.0 / 3.0 * layer.shear_attenuation_db_per_wavelength * layer.shear_speed * layer.shear_speed;
  if (shear > (1.0 + 1e-9) * layer.attenuation_db_per_wavelength * layer.speed * layer.speed)
    field.fault("shear_speed",
                "a solid that gives no energy: attenuation x speed^2 at least 4/3 of that of "
                "its shear waves");
}

}  // namespace

void LayerTable::describe(Fields& field) {
  field(required("thickness"), layer.thickness, layer_thickness, "of the layer");
  describe_waves(field, layer);
}

void LayeredForm::describe(Fields& field) {
  describe_waves(field, below);
  field("layer", layers, "from the water down, over the half space");
}

LayeredFloor LayeredForm::build(const MaterialPlace&) const {
  LayeredFloor floor{.layers = {}, .below = below};
  for (const LayerTable& one : layers) floor.layers.push_back(one.layer);
  return floor;
}

LayeredForm LayeredForm::of(const LayeredFloor& floor) {
  LayeredForm form{.below = floor.below};
  for (const FloorLayer& layer : floor.layers) form.layers.push_back({layer});
  return form;
}

}  // namespace asdic::detail::scenario
