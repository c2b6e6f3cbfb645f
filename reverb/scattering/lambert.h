#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic::detail {

/// Lambert's law, the diffuse sea floor: σ = μ·sin θᵢ·sin θₛ [1/sr], whatever the azimuth.
///
/// 10·log₁₀ μ = −27 dB in deep water (Mackenzie, JASA 33, 1498 (1961)), −25 … −35 over sediments;
/// good below some 45°.
struct Lambert {
  static constexpr std::string_view name = "lambert";
  double mu_db = -27.0;  ///< 10·log₁₀ μ [dB]

  void describe(Fields& field) {
    field("mu_db", mu_db, {.noun = "strength", .unit = "dB", .low = -80.0, .high = 0.0},
          "10·log₁₀ μ");
  }

  [[nodiscard]] double cross_section(const ScatterGeometry& g, double frequency) const noexcept {
    return at(frequency)(sines_of(g));
  }

  /// The law for many directions.
  class At {
   public:
    explicit At(const Lambert& law) noexcept : mu_(power_from_db(law.mu_db)) {}
    [[nodiscard]] double operator()(const ScatterSines& s) const noexcept {
      return mu_ * std::max(0.0, s.sin_in) * std::max(0.0, s.sin_out);
    }

   private:
    double mu_;
  };
  [[nodiscard]] At at(double /*frequency*/) const noexcept { return At(*this); }
};
static_assert(ScatteringModel<Lambert>);

}  // namespace asdic::detail
