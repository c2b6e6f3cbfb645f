#pragma once
#include <string>

#include "raytrace/ocean/boundary.h"

namespace asdic::detail {

/// A material in words, with its figures: "fluid, 1650 m/s, 1900 kg/m3, 0.8 dB per wavelength".
[[nodiscard]] std::string material_text(const BoundaryMaterial& material);

}  // namespace asdic::detail
