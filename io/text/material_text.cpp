#include "io/text/material_text.h"

#include "core/text.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

std::string figures(const Vacuum& /*vacuum*/) { return ""; }
std::string figures(const Rigid& /*rigid*/) { return ""; }

std::string figures(const FluidHalfSpace& fluid) {
  return ", " + to_text(fluid.speed) + " m/s, " + to_text(fluid.density) + " kg/m3, " +
         to_text(fluid.attenuation_db_per_wavelength) + " dB per wavelength";
}

std::string figures(const ElasticHalfSpace& solid) {
  return ", " + to_text(solid.speed) + " m/s, " + to_text(solid.density) + " kg/m3, " +
         to_text(solid.attenuation_db_per_wavelength) + " dB per wavelength, shear " +
         to_text(solid.shear_speed) + " m/s, " +
         to_text(solid.shear_attenuation_db_per_wavelength) + " dB per wavelength";
}

std::string figures(const ReflectionTable& table) {
  return ", " + std::to_string(table.grazing.size()) + " angles from " +
         to_text(degrees(table.grazing.front())) + " to " + to_text(degrees(table.grazing.back())) +
         " degrees";
}

std::string figures(const ReflectionCurves& curves) {
  return ", " + std::to_string(curves.frequency.size()) + " frequencies from " +
         to_text(curves.frequency.front()) + " to " + to_text(curves.frequency.back()) + " Hz";
}

std::string layer_text(const FloorLayer& layer) {
  std::string text = to_text(layer.speed) + " m/s, " + to_text(layer.density) + " kg/m3, " +
                     to_text(layer.attenuation_db_per_wavelength) + " dB per wavelength";
  if (layer.shear_speed > 0.0)
    text += ", shear " + to_text(layer.shear_speed) + " m/s, " +
            to_text(layer.shear_attenuation_db_per_wavelength) + " dB per wavelength";
  return text;
}

std::string figures(const LayeredFloor& floor) {
  std::string text;
  for (const FloorLayer& layer : floor.layers)
    text += ", " + to_text(layer.thickness) + " m of " + layer_text(layer);
  return text + ", over " + layer_text(floor.below);
}

}  // namespace

std::string material_text(const BoundaryMaterial& material) {
  return std::visit([](const auto& m) { return std::string(m.name) + figures(m); }, material);
}

}  // namespace asdic::detail
