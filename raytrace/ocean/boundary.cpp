#include "raytrace/ocean/boundary.h"

#include <cmath>

namespace asdic {
namespace {

using Complex = std::complex<double>;

Complex reflect(const Vacuum& /*vacuum*/, double /*grazing*/, const WaterAtBoundary& /*water*/) {
  return -1.0;
}

Complex reflect(const Rigid& /*rigid*/, double /*grazing*/, const WaterAtBoundary& /*water*/) {
  return 1.0;
}

Complex reflect(const FluidHalfSpace& fluid, double grazing, const WaterAtBoundary& water) {
  const double m = fluid.density / water.density;
  const double loss = fluid.attenuation_db_per_wavelength / 54.575054;  // 40π·log₁₀e dB/λ per unit
  const Complex n = water.speed / fluid.speed * Complex(1.0, -loss);  // k₂/k₁, e^{+iωt}
  const double cosine = std::cos(grazing);
  // s = k₂z/k₁. The principal root has Re s ≥ 0; with Im s² ≤ 0 it lies in the fourth quadrant, and
  // e^{+i(ωt − k·s·z)} then decays away from the boundary. A lossless fluid below critical has
  // s² < 0 exactly: choose Im s < 0 there, too.
  const Complex squared = n * n - cosine * cosine;
  Complex s = std::sqrt(squared);
  if (s.imag() > 0.0) s = -s;
  const Complex incident = m * std::sin(grazing);
  if (incident + s == 0.0) return -1.0;  // equal speeds at grazing incidence: 0/0, its limit
  return (incident - s) / (incident + s);
}

}  // namespace

std::complex<double> reflection_coefficient(const BoundaryMaterial& material, double grazing,
                                            const WaterAtBoundary& water) noexcept {
  return std::visit([&](const auto& behind) { return reflect(behind, grazing, water); }, material);
}

}  // namespace asdic
