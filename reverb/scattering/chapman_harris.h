#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic {

/// Chapman & Harris' empirical law of surface backscatter, from explosive sources in deep water.
///
///   S_s = 3.3·b·log₁₀(θ/30°) − 42.4·log₁₀ b + 2.6 dB,  b = 158·(v·f^⅓)^−0.58,  v in knots, f in
///   Hz, θ in degrees
///
/// JASA 34, 1592 (1962). Valid 400–6400 Hz, below 15 m/s and 40–50°. Bistatically the geometric
/// mean of the two grazing angles stands for θ, which keeps it reciprocal; the azimuth is ignored.
struct ChapmanHarris {
  static constexpr std::string_view name = "chapman-harris";
  double wind_speed = 10.0;  ///< [m/s]
  double sound_speed = 1500.0;

  void describe(auto&&) {}

  [[nodiscard]] double cross_section(const ScatterGeometry& g, double frequency) const noexcept {
    const double theta_deg = degrees(std::sqrt(std::max(0.0, g.grazing_in * g.grazing_out)));
    if (wind_speed <= 0.0 || theta_deg <= 0.0) return 0.0;
    return power_from_db(strength_db(theta_deg, wind_speed, frequency));
  }

  /// S_s [dB] at a grazing angle [°] and wind speed [m/s].
  [[nodiscard]] static double strength_db(double grazing_deg, double wind,
                                          double frequency) noexcept {
    const double knots = wind / 0.514444444444444;
    const double b = 158.0 * std::pow(knots * std::cbrt(frequency), -0.58);
    return 3.3 * b * std::log10(grazing_deg / 30.0) - 42.4 * std::log10(b) + 2.6;
  }
};
static_assert(ScatteringModel<ChapmanHarris>);

}  // namespace asdic
