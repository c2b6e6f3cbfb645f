#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic::detail {

/// Chapman & Harris' empirical law of surface backscatter, from explosive sources in deep water.
///
///   S_s = 3.3·b·log₁₀(θ/30°) − 42.4·log₁₀ b + 2.6 dB,  b = 158·(v·f^⅓)^−0.58
///
/// v in knots, f in Hz, θ in degrees. JASA 34, 1592 (1962). Valid 400–6400 Hz, below 15 m/s and
/// 40–50°. Outside, the law is held where it would say nonsense: above 30° a falling wind finally
/// *raises* it (b → ∞), so b stops where S_s is lowest; and σ ≤ 1. Bistatically the geometric mean
/// of the two grazing angles stands for θ, which keeps it reciprocal; the azimuth is ignored.
struct ChapmanHarris {
  static constexpr std::string_view name = "chapman-harris";
  double wind_speed = 10.0;     ///< [m/s]
  double sound_speed = 1500.0;  ///< not used by this law [m/s]

  void describe(Fields& field) {
    field.derived(wind_speed);
    field.derived(sound_speed);
  }

  [[nodiscard]] static const Validity& validity() noexcept {
    static constexpr ValidRange ranges[] = {{"frequency", "Hz", 400.0, 6400.0},
                                            {"wind speed", "m/s", 0.0, 15.5}};
    static constexpr Validity validity{"Chapman and Harris' law", "JASA 34, 1592, 1962", ranges};
    return validity;
  }

  [[nodiscard]] double cross_section(const ScatterGeometry& g, double frequency) const noexcept {
    const double theta = std::sqrt(std::max(0.0, g.grazing_in * g.grazing_out));
    if (wind_speed <= 0.0 || frequency <= 0.0 || theta <= 0.0) return 0.0;
    return std::min(1.0, power_from_db(strength_db(theta, wind_speed, frequency)));
  }
  [[nodiscard]] LawByAngles<ChapmanHarris> at(double frequency) const noexcept {
    return {*this, frequency};
  }

  /// S_s [dB]. \param grazing  [rad], above 0   \param wind  [m/s], above 0
  /// \param frequency  [Hz], above 0
  [[nodiscard]] static double strength_db(double grazing, double wind, double frequency) noexcept {
    const double knots = wind / 0.514444444444444;
    const double slope = 3.3 * std::log10(degrees(grazing) / 30.0);  // dS/db of the first term
    double b = 158.0 * std::pow(knots * std::cbrt(frequency), -0.58);
    // dS/db = slope − 42.4·log₁₀e/b vanishes here.
    if (slope > 0.0) b = std::min(b, 42.4 / std::numbers::ln10 / slope);
    return slope * b - 42.4 * std::log10(b) + 2.6;
  }
};
static_assert(SurfaceScatteringModel<ChapmanHarris>);

}  // namespace asdic::detail
