#include "raytrace/ocean/boundary.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "raytrace/ocean/layered_floor.h"
#include "raytrace/ocean/number_text.h"
#include "raytrace/ocean/reflection_formulas.h"

namespace asdic::detail {
namespace {

using reflection::Complex;

Complex reflect(const Vacuum& /*vacuum*/, double /*grazing*/, const WaterAtBoundary& /*water*/) {
  return -1.0;
}

Complex reflect(const Rigid& /*rigid*/, double /*grazing*/, const WaterAtBoundary& /*water*/) {
  return 1.0;
}

Complex reflect(const FluidHalfSpace& fluid, double grazing, const WaterAtBoundary& water) {
  return reflection::coefficient(fluid, reflection::numbers(grazing), water);
}

Complex reflect(const ElasticHalfSpace& solid, double grazing, const WaterAtBoundary& water) {
  return reflection::coefficient(solid, reflection::numbers(grazing), water);
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

Complex reflect(const ReflectionCurves& curves, double grazing, const WaterAtBoundary& water) {
  const auto& f = curves.frequency;
  if (f.empty()) return 0.0;
  const auto next =
      static_cast<std::size_t>(std::upper_bound(f.begin(), f.end(), water.frequency) - f.begin());
  if (next == 0) return reflect(curves.curve.front(), grazing, water);
  if (next == f.size()) return reflect(curves.curve.back(), grazing, water);
  const double share = std::log(water.frequency / f[next - 1]) / std::log(f[next] / f[next - 1]);
  const Complex a = reflect(curves.curve[next - 1], grazing, water);
  const Complex b = reflect(curves.curve[next], grazing, water);
  if (a == 0.0 || b == 0.0) return std::lerp(std::abs(a), std::abs(b), share);
  return std::polar(std::lerp(std::abs(a), std::abs(b), share),
                    std::arg(a) + share * std::arg(b / a));
}

Complex reflect(const LayeredFloor& floor, double grazing, const WaterAtBoundary& water) {
  return layered_reflection(floor, grazing, water);
}

}  // namespace

std::complex<double> reflection_coefficient(const BoundaryMaterial& material, double grazing,
                                            const WaterAtBoundary& water) noexcept {
  return std::visit([&](const auto& behind) { return reflect(behind, grazing, water); }, material);
}

namespace {

// The three regressions; every interval is closed below and open above.

/// Speed of the sediment over that of the water.
double speed_ratio(double m) noexcept {
  if (m < 1.0) return (0.002709 * m - 0.056452) * m + 1.2778;
  if (m < 5.3) return ((-0.0014881 * m + 0.0213937) * m - 0.1382798) * m + 1.3425;
  return -0.0024324 * m + 1.0019;
}

/// Density of the sediment over that of the water.
double density_ratio(double m) noexcept {
  if (m < 1.0) return (0.007797 * m - 0.17057) * m + 2.3139;
  if (m < 5.3) return ((-0.0165406 * m + 0.2290201) * m - 1.1069031) * m + 3.0455;
  return -0.0012973 * m + 1.1565;
}

/// Attenuation over frequency [dB/(m·kHz)].
double attenuation_ratio(double m) noexcept {
  if (m < 0.0) return 0.4556;
  if (m < 2.6) return 0.4556 + 0.0245 * m;
  if (m < 4.5) return 0.1978 + 0.1245 * m;
  if (m < 6.0) return 8.0399 + m * (-2.5228 + 0.20098 * m);
  return 0.9431 + m * (-0.2041 + 0.0117 * m);
}

}  // namespace

FluidHalfSpace sediment_of_grain_size(double m, double water_speed, double water_density) {
  if (!(m >= -1.0 && m <= 9.0))
    throw InputError({.where = "grain_size",
                      .got = with_unit(m, "phi"),
                      .expected = "a mean grain size from -1 (coarse sand) to 9 phi (clay)"});
  const double speed = speed_ratio(m) * water_speed;
  return {.speed = speed,
          .density = density_ratio(m) * water_density,
          // one wavelength at 1 kHz is speed/1000 metres
          .attenuation_db_per_wavelength = 1e-3 * speed * attenuation_ratio(m)};
}

}  // namespace asdic::detail
