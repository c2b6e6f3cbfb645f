#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/lambert.h"

namespace asdic::detail {

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

  [[nodiscard]] double cross_section(const ScatterGeometry& g, double frequency) const noexcept {
    return at(frequency)(sines_of(g));
  }

  /// The law for many directions.
  class At {
   public:
    explicit At(const EllisCrowe& law) noexcept
        : diffuse_(Lambert{.mu_db = law.mu_db}), nu_(power_from_db(law.nu_db)) {
      const double s = std::tan(radians(law.slope_deg));
      two_s2_ = 2.0 * s * s;
    }
    [[nodiscard]] double operator()(const ScatterSines& g) const noexcept {
      if (g.sin_in <= 0.0 || g.sin_out <= 0.0) return 0.0;
      const double diffuse = diffuse_(g);
      const double sines = g.sin_in + g.sin_out;
      const double slope2 = g.across2() / (sines * sines);  // ΔΩ
      const double exponent = slope2 / two_s2_;
      if (exponent > 200.0) return diffuse;
      const double facets = nu_ * (1.0 + slope2) * (1.0 + slope2) * std::exp(-exponent);
      return diffuse + std::min(1.0, facets);
    }

   private:
    Lambert::At diffuse_;
    double nu_, two_s2_;
  };
  [[nodiscard]] At at(double /*frequency*/) const noexcept { return At(*this); }
};
static_assert(ScatteringModel<EllisCrowe>);

}  // namespace asdic::detail
