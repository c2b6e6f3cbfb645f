#include "raytrace/waves/interface_wave.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <utility>
#include <variant>

#include "core/units.h"
#include "raytrace/waves/wave_column.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

/// Reflection beside a boundary for waves that decay away from it, by their decay γ [1/m].
class Evanescent {
 public:
  Evanescent(const Environment& ocean, const Boundary& boundary, double frequency)
      : boundary_{.depth = boundary.depth_at(0.0),
                  .material = boundary.material_at(0.0),
                  .shape = {},
                  .roughness = {}},
        water_{.speed = sound_speed(ocean, 0.0, boundary.depth_at(0.0)).c,
               .density = ocean.water_density.at(boundary.depth_at(0.0)),
               .frequency = frequency},
        omega_(2.0 * pi * frequency) {}

  [[nodiscard]] bool may_have_poles() const {
    return std::holds_alternative<FluidHalfSpace>(boundary_.material) ||
           std::holds_alternative<ElasticHalfSpace>(boundary_.material) ||
           std::holds_alternative<LayeredFloor>(boundary_.material);
  }
  [[nodiscard]] Complex wavenumber(Complex gamma) const {
    const double k = omega_ / water_.speed;
    return std::sqrt(k * k + gamma * gamma);
  }
  /// 1/R, which is zero at a pole.
  [[nodiscard]] Complex inverse(Complex gamma) const {
    return 1.0 /
           reflection_at(boundary_, water_, omega_, wavenumber(gamma), Complex(0.0, -1.0) * gamma);
  }

  /// The pole beside a place, by the secant method.
  [[nodiscard]] std::optional<Complex> pole_beside(double gamma) const {
    constexpr int most_steps = 40;
    Complex a = gamma * 0.999, b = gamma, at_a = inverse(a), at_b = inverse(b);
    for (int i = 0; i < most_steps && at_a != at_b; ++i) {
      const Complex next = b - at_b * (b - a) / (at_b - at_a);
      if (!(std::abs(next - gamma) < 0.5 * gamma)) return {};
      if (std::abs(next - b) < 1e-10 * gamma) return next;
      a = std::exchange(b, next), at_a = std::exchange(at_b, inverse(next));
    }
    return {};
  }

 private:
  Boundary boundary_;
  WaterAtBoundary water_;
  double omega_;
};

}  // namespace

std::vector<InterfaceWave> interface_waves(const Environment& ocean, const Boundary& boundary,
                                           double frequency, double away) {
  constexpr double faintest = 7.0;  // γ(h₁ + h₂): −60 dB
  constexpr int places = 400;       // of γ, where 1/|R| is looked at
  const Evanescent wall(ocean, boundary, frequency);
  const double k = wall.wavenumber(0.0).real(),
               highest = std::min(faintest / std::max(away, 1e-6), 20.0 * k), lowest = 1e-3 * k;
  std::vector<InterfaceWave> found;
  if (!wall.may_have_poles() || highest <= lowest) return found;
  const auto place = [&](int i) { return lowest * std::pow(highest / lowest, double(i) / places); };
  double before = infinity, here = std::abs(wall.inverse(place(0)));
  for (int i = 0; i < places; ++i) {
    const double next = std::abs(wall.inverse(place(i + 1)));
    if (here < before && here <= next && here < 1.0)
      if (const auto gamma = wall.pole_beside(place(i)); gamma && gamma->real() > 0.0) {
        const Complex xi = wall.wavenumber(*gamma), step = 1e-5 * *gamma;
        const Complex slope =  // of 1/R over ξ, dγ/dξ = ξ/γ
            (wall.inverse(*gamma + step) - wall.inverse(*gamma - step)) / (2.0 * step) * xi /
            *gamma;
        found.push_back({.wavenumber = xi, .decay = *gamma, .residue = 1.0 / slope});
      }
    before = std::exchange(here, next);
  }
  return found;
}

double interface_wave_pressure(const Environment& ocean, double source_depth, double receiver_depth,
                               double range, double frequency) {
  double sum = 0.0;
  for (const Boundary* boundary : {&ocean.surface, &ocean.bottom}) {
    const double depth = boundary->depth_at(0.0),
                 away = std::abs(source_depth - depth) + std::abs(receiver_depth - depth);
    for (const InterfaceWave& wave : interface_waves(ocean, *boundary, frequency, away)) {
      const double decay = wave.decay.real() * away + std::abs(wave.wavenumber.imag()) * range;
      const double p = pi * std::abs(wave.wavenumber / wave.decay * wave.residue) *
                       std::sqrt(2.0 / (pi * std::abs(wave.wavenumber) * std::max(range, 1e-3))) *
                       std::exp(-decay);
      sum += p * p;
    }
  }
  return std::sqrt(sum);
}

}  // namespace asdic::detail
