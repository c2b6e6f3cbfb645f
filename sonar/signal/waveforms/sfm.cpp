#include "sonar/signal/waveforms/sfm.h"

#include <algorithm>
#include <cmath>

#include "core/quantities.h"
#include "core/text.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

/// The auxiliary functions of Fresnel's integrals, Abramowitz & Stegun 7.3.5 and 7.3.6.
struct FresnelAuxiliary {
  double f, g;
};

/// By Taylor's series of C and S (7.3.11, 7.3.13), x ≤ 1.5.
FresnelAuxiliary auxiliary_by_series(double x) noexcept {
  const double z = 0.5 * pi * x * x;
  double c = 0.0, s = 0.0, term = x;  // (iz)ⁿ/n!·x, its real and imaginary parts in turn
  for (int n = 0; n < 40; ++n) {
    const double part = term / (2.0 * n + 1.0);
    (n % 2 == 0 ? c : s) += n % 4 < 2 ? part : -part;
    term *= z / (n + 1.0);
  }
  const double rest_c = 0.5 - c, rest_s = 0.5 - s, cosine = std::cos(z), sine = std::sin(z);
  return {.f = rest_s * cosine - rest_c * sine, .g = rest_c * cosine + rest_s * sine};
}

/// By their integrals, (√2/π)∫₀^∞ {1, s²} e^{−πx²s²/2}/(1 + s⁴) ds: trapezoids of a width h leave
/// e^{−√2π/h} of the poles, e^{−2π/(xh)²} of the exponential, both below 1e-15.
FresnelAuxiliary auxiliary_by_trapezoids(double x) noexcept {
  const double h = std::min(0.125, 0.4 / x);
  double f = 0.5, g = 0.0;
  for (int k = 1;; ++k) {
    const double s = k * h, exponent = 0.5 * pi * x * x * s * s;
    if (exponent > 37.0) break;
    const double value = std::exp(-exponent) / (1.0 + s * s * s * s);
    f += value;
    g += s * s * value;
  }
  const double scale = std::numbers::sqrt2 / pi * h;
  return {.f = scale * f, .g = scale * g};
}

FresnelAuxiliary fresnel_auxiliary(double x) noexcept {
  return x < 1.5 ? auxiliary_by_series(x) : auxiliary_by_trapezoids(x);
}

}  // namespace

void Sfm::describe(Fields& field) {
  field(required("frequency"), frequency, quantity::frequency, "about which it swings");
  field(required("swing"), swing, quantity::frequency_step,
        "from the lowest to the highest frequency");
  field(required("modulation_frequency"), modulation_frequency, quantity::frequency_step,
        "of the swings");
  field(by_default("end_modulation_frequency", "modulation_frequency"), end_modulation_frequency,
        quantity::frequency_step, "of the swings at the trailing edge, where it goes to linearly");
}

void Sfm::check(Fields& field, double /*duration*/) const {
  if (!(frequency > 0.5 * swing))
    field.fault("frequency", "one above " + to_text(0.5 * swing) + " Hz, half of the swing");
}

double Sfm::phase(double t, double duration) const noexcept {
  const double rate =
      (end_modulation_frequency.value_or(modulation_frequency) - modulation_frequency) / duration;
  const auto swings = [&](double at) {  // ψ
    return 2.0 * pi * at * (modulation_frequency + 0.5 * rate * at);
  };
  if (rate == 0.0)
    return 2.0 * pi * frequency * t +
           0.5 * swing / modulation_frequency * std::sin(swings(t));  // β sin ψ
  // ∫cos ψ dt = [f(x) sin ψ ∓ g(x) cos ψ]/√(2|μ|), x = f_m√(2/|μ|), μ = df_m/dt, ∓ its sign: of the
  // Fresnel integrals without their large constant phase.
  const double by = std::sqrt(2.0 * std::abs(rate));
  const auto integral = [&](double at) {
    const double x = 2.0 * (modulation_frequency + rate * at) / by;
    const FresnelAuxiliary of = fresnel_auxiliary(x);
    return (of.f * std::sin(swings(at)) - std::copysign(of.g, rate) * std::cos(swings(at))) / by;
  };
  return 2.0 * pi * frequency * t + pi * swing * (integral(t) - integral(0.0));
}

}  // namespace asdic::detail
