#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/chapman_harris.h"

namespace asdic {

/// Ogden & Erskine's blend of Chapman–Harris with perturbation theory: calm seas follow the rough
/// interface, rough ones the bubbles.
///
///   S_s = a·CH + (1 − a)·P dB,  a = (U − U_p)/(U_c − U_p) within 0..1
///   P   = 10·log₁₀[1.61·10⁻⁴ tan⁴θ · exp(−1.01·10⁶/(f²U⁴cos²θ))]
///
/// JASA 95, 746 (1994). Valid 50–1000 Hz, below 20 m/s and 40°. Bistatically as ChapmanHarris.
struct OgdenErskine {
  static constexpr std::string_view name = "ogden-erskine";
  double wind_speed = 10.0;  ///< U [m/s]
  double sound_speed = 1500.0;

  void describe(auto&&) {}

  [[nodiscard]] double cross_section(const ScatterGeometry& g, double frequency) const noexcept {
    const double theta = std::sqrt(std::max(0.0, g.grazing_in * g.grazing_out));
    if (wind_speed <= 0.0 || theta <= 0.0) return 0.0;
    return power_from_db(strength_db(theta, wind_speed, frequency));
  }

  /// S_s [dB] at a grazing angle [rad].
  [[nodiscard]] static double strength_db(double theta, double wind, double f) noexcept {
    const double upper = f < 240.0 ? 21.5 - 0.0595 * f : 7.22;                         // U_p
    const double lower = 20.14 - 0.0340 * f + 3.64e-5 * f * f - 1.330e-8 * f * f * f;  // U_c
    const double a = std::clamp((wind - upper) / (lower - upper), 0.0, 1.0);
    const double chapman_harris = ChapmanHarris::strength_db(degrees(theta), wind, f);
    if (a >= 1.0) return chapman_harris;
    const double cosine = std::cos(theta);
    const double perturbation =
        db_from_power(1.61e-4) + 40.0 * std::log10(std::tan(theta)) -
        db_from_power(std::exp(1.0)) * 1.01e6 / (f * f * std::pow(wind, 4) * cosine * cosine);
    return a * chapman_harris + (1.0 - a) * perturbation;
  }
};
static_assert(ScatteringModel<OgdenErskine>);

}  // namespace asdic
