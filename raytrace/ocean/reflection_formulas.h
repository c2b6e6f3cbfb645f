#pragma once
// Plane-wave reflection coefficients of the half spaces, for numbers and for jets alike.
#include <cmath>
#include <complex>
#include <type_traits>

#include "raytrace/ocean/boundary.h"

namespace asdic::detail::reflection {

using Complex = std::complex<double>;

/// A function of one variable with its first two derivatives: f, f′, f″. Arithmetic by the rules of
/// Leibniz, so that a formula written for numbers gives its own derivatives.
struct Jet {
  Complex f, d = 0.0, dd = 0.0;
  Jet(Complex value, Complex first = 0.0, Complex second = 0.0)  // NOLINT: numbers are jets
      : f(value), d(first), dd(second) {}
  Jet(double value) : f(value) {}  // NOLINT
};
inline Jet operator+(const Jet& a, const Jet& b) { return {a.f + b.f, a.d + b.d, a.dd + b.dd}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.f - b.f, a.d - b.d, a.dd - b.dd}; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.f * b.f, a.d * b.f + a.f * b.d, a.dd * b.f + 2.0 * a.d * b.d + a.f * b.dd};
}
/// q = a/b: q′ = (a′ − q·b′)/b, q″ = (a″ − 2q′b′ − q·b″)/b
inline Jet operator/(const Jet& a, const Jet& b) {
  const Complex q = a.f / b.f, d = (a.d - q * b.d) / b.f;
  return {q, d, (a.dd - 2.0 * d * b.d - q * b.dd) / b.f};
}
/// r = ±√a: r′ = a′/2r, r″ = (a″ − 2r′²)/2r
inline Jet with_root(const Jet& a, Complex root) {
  const Complex d = a.d / (2.0 * root);
  return {root, d, (a.dd - 2.0 * d * d) / (2.0 * root)};
}
inline Complex with_root(const Complex& /*square*/, Complex root) { return root; }
inline const Complex& value(const Complex& x) { return x; }
inline const Complex& value(const Jet& x) { return x.f; }

/// sin and cos of a grazing angle: numbers, or functions of it.
template <class Real>
struct Grazing {
  Real sine, cosine;
};
inline Grazing<double> numbers(double angle) { return {std::sin(angle), std::cos(angle)}; }
inline Grazing<Jet> jets(double angle) {
  const double s = std::sin(angle), c = std::cos(angle);
  return {{s, c, -s}, {c, -s, -c}};
}

/// k₂/k₁ of a wave behind the boundary, e^{+iωt}: it decays as it travels.
inline Complex refraction_index(double speed, double db_per_wavelength,
                                const WaterAtBoundary& water) {
  const double loss = db_per_wavelength / 54.575054;  // 40π·log₁₀e dB/λ per unit
  return water.speed / speed * Complex(1.0, -loss);
}

/// s = k₂z/k₁ = √(n² − cos²θ). The principal root has Re s ≥ 0; with Im s² ≤ 0 it lies in the
/// fourth quadrant, and e^{+i(ωt − k·s·z)} then decays away from the boundary. A lossless medium
/// below critical has s² < 0 exactly: choose Im s < 0 there, too.
template <class Real>
auto vertical_index(const Complex& index, const Real& cosine) {
  const auto square = index * index - cosine * cosine;
  const Complex s = std::sqrt(value(square));
  return with_root(square, s.imag() > 0.0 ? -s : s);
}

/// R = (incident − s)/(incident + s), of complex numbers or jets
template <class Number>
Number mismatch(const Number& incident, const Number& s) {
  if (value(incident) + value(s) == 0.0) return -1.0;  // equal speeds at grazing incidence: 0/0
  return (incident - s) / (incident + s);
}

template <class Real>
auto coefficient(const FluidHalfSpace& fluid, const Grazing<Real>& at,
                 const WaterAtBoundary& water) {
  const double m = fluid.density / water.density;
  const Complex n = refraction_index(fluid.speed, fluid.attenuation_db_per_wavelength, water);
  const auto s = vertical_index(n, at.cosine);
  return mismatch<std::decay_t<decltype(s)>>(m * at.sine, s);
}

template <class Real>
auto coefficient(const ElasticHalfSpace& solid, const Grazing<Real>& at,
                 const WaterAtBoundary& water) {
  const double m = solid.density / water.density;
  const Complex n = refraction_index(solid.speed, solid.attenuation_db_per_wavelength, water);
  const Real& k = at.cosine;  // horizontal slowness, of all waves alike, times c₁
  const auto s = vertical_index(n, k);
  using Number = std::decay_t<decltype(s)>;
  if (!(solid.shear_speed > 0.0)) return mismatch<Number>(m * at.sine, s);
  const Complex shear =
      refraction_index(solid.shear_speed, solid.shear_attenuation_db_per_wavelength, water);
  const auto s_shear = vertical_index(shear, k);
  const Complex shear2 = shear * shear;
  // G = cos²2θ_s + (s/s_s)·sin²2θ_s, θ_s the shear wave's angle: cos 2θ_s = 1 − 2k²/n_s²
  const auto split = 1.0 - 2.0 * k * k / shear2;
  const auto g = split * split + 4.0 * k * k * s * s_shear / (shear2 * shear2);
  return mismatch<Number>(m * at.sine * g, s);
}

}  // namespace asdic::detail::reflection
