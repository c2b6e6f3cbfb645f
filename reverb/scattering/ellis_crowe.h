#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic {

/// Bistatic sea floor: Lambert's diffuse law and a lobe of facets about the specular direction.
///
///   σ  = μ·sin θᵢ·sin θₛ + ν·(1 + ΔΩ)²·exp(−ΔΩ/(2s²)),  at most 1 for each term
///   ΔΩ = [cos²θᵢ + cos²θₛ − 2 cos θᵢ cos θₛ cos φ]/(sin θᵢ + sin θₛ)²
///
/// ΔΩ is the squared tangent of the slope that a facet needs to mirror the one direction into the
/// other (φ change of direction, 0 forward), s the rms slope. Ellis & Crowe, JASA 89, 2207 (1991).
/// ν and s as measured over sediments: −10 … −20 dB, 5 … 15°.
struct EllisCrowe {
  static constexpr std::string_view name = "ellis-crowe";
  double mu_db = -27.0;     ///< 10·log₁₀ μ, diffuse [dB]
  double nu_db = -15.0;     ///< 10·log₁₀ ν, facets [dB]
  double slope_deg = 10.0;  ///< rms slope angle of the facets, s = tan of it [degrees]

  void describe(Fields& field) {
    field("mu_db", mu_db, {.noun = "strength", .unit = "dB", .low = -80.0, .high = 0.0},
          "10·log₁₀ μ, diffuse");
    field("nu_db", nu_db, {.noun = "strength", .unit = "dB", .low = -80.0, .high = 10.0},
          "10·log₁₀ ν, of the facets");
    field("slope_deg", slope_deg, {.noun = "slope", .unit = "degrees", .low = 0.5, .high = 45.0},
          "rms slope angle of the facets");
  }

  [[nodiscard]] double cross_section(const ScatterGeometry& g,
                                     double /*frequency*/) const noexcept {
    const double sin_in = std::sin(g.grazing_in), sin_out = std::sin(g.grazing_out);
    if (sin_in <= 0.0 || sin_out <= 0.0) return 0.0;
    const double diffuse = power_from_db(mu_db) * sin_in * sin_out;
    // cos²θᵢ + cos²θₛ − 2 cos cos cos φ = (cos θᵢ − cos θₛ)² + 4 cos cos sin²(φ/2): nothing
    // cancels.
    const double difference = 2.0 * std::sin(0.5 * (g.grazing_in + g.grazing_out)) *
                              std::sin(0.5 * (g.grazing_in - g.grazing_out));
    const double turn = std::sin(0.5 * g.azimuth);
    const double across = difference * difference +
                          4.0 * std::cos(g.grazing_in) * std::cos(g.grazing_out) * turn * turn;
    const double slope2 = across / ((sin_in + sin_out) * (sin_in + sin_out));  // ΔΩ
    const double s = std::tan(radians(slope_deg));
    const double exponent = slope2 / (2.0 * s * s);
    if (exponent > 200.0) return diffuse;
    const double facets =
        power_from_db(nu_db) * (1.0 + slope2) * (1.0 + slope2) * std::exp(-exponent);
    return diffuse + std::min(1.0, facets);
  }
};
static_assert(ScatteringModel<EllisCrowe>);

}  // namespace asdic
