#include "raytrace/ocean/strongest_reflection.h"

#include <cmath>

#include "core/units.h"

namespace asdic::detail {

StrongestReflection strongest_reflection(const BoundaryMaterial& material,
                                         const WaterAtBoundary& water) noexcept {
  constexpr int steps = 900;
  StrongestReflection most;
  for (int i = 0; i <= steps; ++i) {
    const double grazing = 0.5 * pi * i / steps;
    const double magnitude = std::abs(reflection_coefficient(material, grazing, water));
    if (magnitude > most.magnitude) most = {.grazing = grazing, .magnitude = magnitude};
  }
  return most;
}

}  // namespace asdic::detail
