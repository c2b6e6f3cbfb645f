#include "raytrace/ocean/boundary.h"

#include <algorithm>
#include <cmath>

#include "raytrace/ocean/layered_floor.h"
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

}  // namespace asdic::detail
