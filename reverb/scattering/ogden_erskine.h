#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/chapman_harris.h"

namespace asdic::detail {

/// Ogden & Erskine's blend of Chapman–Harris with perturbation theory: calm seas follow the rough
/// interface, rough ones the bubbles.
///
///   S_s = a·CH + (1 − a)·P dB,  a = (U − U_p)/(U_c − U_p) within 0..1
///   P   = 10·log₁₀[1.61·10⁻⁴ tan⁴θ · exp(−1.01·10⁶/(f²U⁴cos²θ))]
///   U_p = 21.5 − 0.0595f (f < 240 Hz), else 7.22 m/s
///   U_c = 20.14 − 0.0340f + 3.64·10⁻⁵f² − 1.330·10⁻⁸f³ m/s
///
/// JASA 95, 746 (1994). Valid 50–1000 Hz, below 20 m/s and 40°; outside these frequencies the two
/// winds U_p and U_c stay what they are at 50 or 1000 Hz (their polynomials cross there, which
/// would turn the blend round), and σ ≤ 1. Bistatically as ChapmanHarris.
struct OgdenErskine {
  static constexpr std::string_view name = "ogden-erskine";
  double wind_speed = 10.0;     ///< U [m/s]
  double sound_speed = 1500.0;  ///< not used by this law [m/s]

  void describe(Fields& field) {
    field.derived(wind_speed);
    field.derived(sound_speed);
  }

  [[nodiscard]] static const Validity& validity() noexcept {
    static constexpr ValidRange ranges[] = {{"frequency", "Hz", 50.0, 1000.0},
                                            {"wind speed", "m/s", 0.0, 20.0}};
    static constexpr Validity validity{"Ogden and Erskine's law", "JASA 95, 746, 1994", ranges};
    return validity;
  }

  [[nodiscard]] double cross_section(const ScatterGeometry& g, double frequency) const noexcept {
    const double theta = std::sqrt(std::max(0.0, g.grazing_in * g.grazing_out));
    if (wind_speed <= 0.0 || frequency <= 0.0 || theta <= 0.0) return 0.0;
    return std::min(1.0, power_from_db(strength_db(theta, wind_speed, frequency)));
  }
  [[nodiscard]] LawByAngles<OgdenErskine> at(double frequency) const noexcept {
    return {*this, frequency};
  }

  /// S_s [dB]. \param grazing  [rad], above 0   \param wind  [m/s], above 0
  /// \param frequency  [Hz], above 0
  [[nodiscard]] static double strength_db(double grazing, double wind, double frequency) noexcept {
    const double f = std::clamp(frequency, 50.0, 1000.0);
    const double calm = f < 240.0 ? 21.5 - 0.0595 * f : 7.22;                   // U_p
    const double rough = 20.14 + f * (-0.0340 + f * (3.64e-5 - f * 1.330e-8));  // U_c
    const double a = std::clamp((wind - calm) / (rough - calm), 0.0, 1.0);
    const double chapman_harris = ChapmanHarris::strength_db(grazing, wind, frequency);
    return a >= 1.0 ? chapman_harris
                    : a * chapman_harris + (1.0 - a) * interface_db(grazing, wind, frequency);
  }

  /// P [dB]: first-order perturbation theory on a Pierson–Moskowitz sea.
  [[nodiscard]] static double interface_db(double grazing, double wind, double f) noexcept {
    const double cosine = std::max(1e-9, std::cos(grazing));  // never quite vertical
    const double tangent = std::sin(grazing) / cosine;
    const double exponent = 1.01e6 / (f * f * std::pow(wind, 4) * cosine * cosine);
    return 10.0 * std::log10(1.61e-4) + 40.0 * std::log10(tangent) -
           10.0 * std::numbers::log10e * exponent;
  }
};
static_assert(SurfaceScatteringModel<OgdenErskine>);

}  // namespace asdic::detail
