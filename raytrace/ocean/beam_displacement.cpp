#include "raytrace/ocean/beam_displacement.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/reflection_formulas.h"

namespace asdic::detail {
namespace {

using reflection::Jet;

/// φ_θ and φ_θθ of a coefficient's phase.
struct PhaseSlope {
  double first = 0.0, second = 0.0;
};

/// φ = Im ln R: φ_θ = Im(R′/R), φ_θθ = Im(R″/R − (R′/R)²)
template <class HalfSpace>
PhaseSlope half_space(const HalfSpace& m, double grazing, const WaterAtBoundary& water) noexcept {
  const Jet r = reflection::coefficient(m, reflection::jets(grazing), water);
  const auto slope = r.d / r.f;
  return {slope.imag(), (r.dd / r.f - slope * slope).imag()};
}

struct SlopeOf {
  double grazing;
  const WaterAtBoundary& water;

  PhaseSlope operator()(const Vacuum&) const noexcept { return {}; }
  PhaseSlope operator()(const Rigid&) const noexcept { return {}; }
  PhaseSlope operator()(const ReflectionTable& table) const noexcept {
    const auto& a = table.grazing;
    if (a.size() < 2 || grazing < a.front() || grazing > a.back()) return {};
    const auto next = std::upper_bound(a.begin() + 1, a.end() - 1, grazing);
    const auto i = static_cast<std::size_t>(next - a.begin());
    return {(table.phase[i] - table.phase[i - 1]) / (a[i] - a[i - 1]), 0.0};
  }
  PhaseSlope operator()(const ReflectionCurves& curves) const noexcept {
    return by_differences(curves);
  }
  PhaseSlope operator()(const LayeredFloor& floor) const noexcept { return by_differences(floor); }
  PhaseSlope operator()(const auto& m) const noexcept { return half_space(m, grazing, water); }

  /// Of materials without derivatives.
  [[nodiscard]] PhaseSlope by_differences(const BoundaryMaterial& material) const noexcept {
    constexpr double h = 1e-5;
    const auto r = [&](double angle) {
      return reflection_coefficient(material, std::clamp(angle, 0.0, 0.5 * pi), water);
    };
    const auto here = r(grazing);
    const double after = std::arg(r(grazing + h) / here), before = std::arg(here / r(grazing - h));
    return {(after + before) / (2.0 * h), (after - before) / (h * h)};
  }
};

}  // namespace

BeamDisplacement beam_displacement(const BoundaryMaterial& material, double grazing,
                                   const WaterAtBoundary& water, double frequency) noexcept {
  const double wave = water.speed / (2.0 * pi * frequency);  // c/ω
  const double sine = std::sin(grazing), cosine = std::cos(grazing);
  const PhaseSlope phi = std::visit(SlopeOf{grazing, water}, material);
  BeamDisplacement moved;
  moved.length = -wave * phi.first / sine;
  moved.per_grazing = -wave * (phi.second - phi.first * cosine / sine) / sine;
  if (!std::isfinite(moved.length) || !std::isfinite(moved.per_grazing)) return {};
  // A central difference: rounding leaves 1e-10 of Δ, and its own error is (h/δ)² at δ radians from
  // a critical angle.
  constexpr double h = 1e-6;
  const auto length = [&](double factor) {
    const WaterAtBoundary there{
        .speed = factor * water.speed, .density = water.density, .frequency = water.frequency};
    return -factor * wave * std::visit(SlopeOf{grazing, there}, material).first / sine;
  };
  if (phi.first != 0.0)
    moved.per_speed = (length(1.0 + h) - length(1.0 - h)) / (2.0 * h * water.speed);
  if (!std::isfinite(moved.per_speed)) moved.per_speed = 0.0;
  return moved;
}

}  // namespace asdic::detail
