#include "sonar/synthesis/delay_kernel.h"

#include <array>
#include <cmath>

#include "core/units.h"
#include "sonar/signal/windowed_sinc.h"

namespace asdic::detail {
namespace {

// The bump is I₀(β√(1 − (2x/w)²)); its spectrum turns from growth to ripple at β = πwξ. That is put
// just below the first image of the band's edge, ξ = 1 − ½/oversampling.
constexpr double beta = 0.98 * pi * DelayKernel::taps * (1.0 - 0.5 / DelayKernel::oversampling);

}  // namespace

DelayKernel::DelayKernel() {
  // Interpolation through the Chebyshev points of [−1, 1]: I₀ of a square root is entire, so nine
  // degrees leave less than float's rounding.
  constexpr std::size_t points = degree + 1;
  for (int tap = 0; tap < taps; ++tap) {
    std::array<double, points> monomial{};
    std::array<double, points> previous{}, current{};  // coefficients of T_{k−1} and T_k
    current[0] = 1.0;
    for (std::size_t k = 0; k < points; ++k) {
      double coefficient = 0.0;  // c_k = (2 − δ_k0)/N Σ f(y_i) cos(k θ_i), y_i = cos θ_i
      for (std::size_t i = 0; i < points; ++i) {
        const double theta = pi * (static_cast<double>(i) + 0.5) / points;
        coefficient +=
            kaiser_window(2.0 * (tap - before - 0.5 * (std::cos(theta) + 1.0)) / taps, beta) *
            std::cos(static_cast<double>(k) * theta) * (k == 0 ? 1.0 : 2.0) / points;
      }
      for (std::size_t j = 0; j < points; ++j) monomial[j] += coefficient * current[j];
      std::array<double, points> next{};  // T_{k+1} = 2y T_k − T_{k−1}, T₁ = y
      for (std::size_t j = 0; j < points; ++j)
        next[j] = (j > 0 ? (k == 0 ? 1.0 : 2.0) * current[j - 1] : 0.0) - previous[j];
      previous = current;
      current = next;
    }
    for (std::size_t j = 0; j < points; ++j)
      polynomial_[j](2 * tap) = polynomial_[j](2 * tap + 1) = static_cast<float>(monomial[j]);
  }
}

const DelayKernel& DelayKernel::shared() {
  static const DelayKernel kernel;
  return kernel;
}

double DelayKernel::spectrum(double frequency) const noexcept {
  const double a = pi * taps * frequency;
  const double root = std::sqrt(beta * beta - a * a);  // real inside the band
  static const double peak = std::cyl_bessel_i(0.0, beta);
  return taps * std::sinh(root) / (root * peak);
}

}  // namespace asdic::detail
