#include "raytrace/ocean/boundary.h"

#include <algorithm>
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

/// k₂/k₁ of a wave behind the boundary, e^{+iωt}: it decays as it travels.
Complex refraction_index(double speed, double db_per_wavelength, const WaterAtBoundary& water) {
  const double loss = db_per_wavelength / 54.575054;  // 40π·log₁₀e dB/λ per unit
  return water.speed / speed * Complex(1.0, -loss);
}

/// s = k₂z/k₁ = √(n² − cos²θ). The principal root has Re s ≥ 0; with Im s² ≤ 0 it lies in the
/// fourth quadrant, and e^{+i(ωt − k·s·z)} then decays away from the boundary. A lossless medium
/// below critical has s² < 0 exactly: choose Im s < 0 there, too.
Complex vertical_index(const Complex& index, double cosine) {
  const Complex s = std::sqrt(index * index - cosine * cosine);
  return s.imag() > 0.0 ? -s : s;
}

/// R = (incident − s)/(incident + s)
Complex mismatch(const Complex& incident, const Complex& s) {
  if (incident + s == 0.0) return -1.0;  // equal speeds at grazing incidence: 0/0, its limit
  return (incident - s) / (incident + s);
}

Complex reflect(const FluidHalfSpace& fluid, double grazing, const WaterAtBoundary& water) {
  const double m = fluid.density / water.density;
  const Complex n = refraction_index(fluid.speed, fluid.attenuation_db_per_wavelength, water);
  return mismatch(m * std::sin(grazing), vertical_index(n, std::cos(grazing)));
}

Complex reflect(const ElasticHalfSpace& solid, double grazing, const WaterAtBoundary& water) {
  const double m = solid.density / water.density;
  const Complex n = refraction_index(solid.speed, solid.attenuation_db_per_wavelength, water);
  const double k = std::cos(grazing);  // horizontal slowness, of all waves alike, times c₁
  const Complex s = vertical_index(n, k);
  if (!(solid.shear_speed > 0.0)) return mismatch(m * std::sin(grazing), s);
  const Complex shear =
      refraction_index(solid.shear_speed, solid.shear_attenuation_db_per_wavelength, water);
  const Complex s_shear = vertical_index(shear, k);
  const Complex shear2 = shear * shear;
  // G = cos²2θ_s + (s/s_s)·sin²2θ_s, θ_s the shear wave's angle: cos 2θ_s = 1 − 2k²/n_s²
  const Complex split = 1.0 - 2.0 * k * k / shear2;
  const Complex g = split * split + 4.0 * k * k * s * s_shear / (shear2 * shear2);
  return mismatch(m * std::sin(grazing) * g, s);
}

Complex reflect(const ReflectionTable& table, double grazing, const WaterAtBoundary& /*water*/) {
  const auto& angle = table.grazing;
  if (angle.empty() || grazing < angle.front() || grazing > angle.back()) return 0.0;
  if (angle.size() == 1) return std::polar(table.magnitude[0], table.phase[0]);
  const auto next = std::upper_bound(angle.begin() + 1, angle.end() - 1, grazing);
  const auto i = static_cast<std::size_t>(next - angle.begin());
  const double share = (grazing - angle[i - 1]) / (angle[i] - angle[i - 1]);
  return std::polar(std::lerp(table.magnitude[i - 1], table.magnitude[i], share),
                    std::lerp(table.phase[i - 1], table.phase[i], share));
}

}  // namespace

std::complex<double> reflection_coefficient(const BoundaryMaterial& material, double grazing,
                                            const WaterAtBoundary& water) noexcept {
  return std::visit([&](const auto& behind) { return reflect(behind, grazing, water); }, material);
}

}  // namespace asdic
