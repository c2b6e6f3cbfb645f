#include "raytrace/layered/simd_reflection.h"

#include <algorithm>
#include <complex>

namespace asdic::detail {
namespace {

SimdComplex power(SimdComplex base, std::array<int, rays_at_once> exponent) noexcept {
  SimdComplex product;
  while (std::any_of(exponent.begin(), exponent.end(), [](int n) { return n > 0; })) {
    const auto odd = Rays([&](auto i) { return exponent[i] % 2 == 1 ? 1.0 : 0.0; }) > 0.5;
    const SimdComplex more = product * base;
    where(odd, product.real) = more.real;
    where(odd, product.imag) = more.imag;
    base = base * base;
    for (int& n : exponent) n /= 2;
  }
  return product;
}

/// R = (M − s)/(M + s), M = m·sin θ, s² = n² − cos²θ with Im s² ≤ 0, Re s ≥ 0 ≥ Im s.
SimdComplex of_fluid(const FluidHalfSpace& fluid, const WaterAtBoundary& water, const Rays& sine,
                     const Rays& cosine) noexcept {
  const double loss = fluid.attenuation_db_per_wavelength / 54.575054;
  const double ratio = water.speed / fluid.speed;
  const Rays a = ratio * ratio * (1.0 - loss * loss) - cosine * cosine;
  const Rays b = -2.0 * ratio * ratio * loss;
  const Rays size = sqrt(a * a + b * b);
  // the larger of the two parts of s by a root without cancellation, the other from b = 2 Re Im
  const Rays larger = sqrt(0.5 * (size + abs(a)));
  Rays smaller = 0.5 * b / larger;
  where(larger == 0.0, smaller) = 0.0;
  Rays re = larger, im = smaller;
  where(a < 0.0, re) = -smaller;
  where(a < 0.0, im) = -larger;
  const Rays m = fluid.density / water.density * sine;
  const Rays sum = m + re, per = 1.0 / (sum * sum + im * im);
  SimdComplex r{(m * m - size) * per, -2.0 * m * im * per};
  const auto equal = sum * sum + im * im == 0.0;  // equal speeds at grazing incidence: its limit
  where(equal, r.real) = -1.0;
  where(equal, r.imag) = 0.0;
  return r;
}

}  // namespace

SimdComplex reflections_of(const BoundaryMaterial& material, const WaterAtBoundary& water,
                           const Rays& sine, const Rays& cosine, const Rays& grazing,
                           std::array<int, rays_at_once> bounces) noexcept {
  if (std::all_of(bounces.begin(), bounces.end(), [](int n) { return n == 0; })) return {};
  if (const auto* fluid = std::get_if<FluidHalfSpace>(&material))
    return power(of_fluid(*fluid, water, sine, cosine), bounces);
  SimdComplex r;
  for (std::size_t i = 0; i < rays_at_once; ++i) {
    const std::complex<double> one = reflection_coefficient(material, grazing[i], water);
    r.real[i] = one.real();
    r.imag[i] = one.imag();
  }
  return power(r, bounces);
}

}  // namespace asdic::detail
