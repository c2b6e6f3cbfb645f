#include "io/text/material_text.h"

#include "core/units.h"
#include "io/text/toml_value.h"

namespace asdic {
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

}  // namespace

std::string material_text(const BoundaryMaterial& material) {
  return std::visit([](const auto& m) { return std::string(m.name) + figures(m); }, material);
}

}  // namespace asdic
