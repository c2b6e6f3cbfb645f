#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic {

/// Lambert's law, the diffuse sea floor: σ = μ·sin θᵢ·sin θₛ [1/sr], whatever the azimuth.
///
/// 10·log₁₀ μ = −27 dB in deep water (Mackenzie, JASA 33, 1498 (1961)), −25 … −35 over sediments;
/// good below some 45°.
struct Lambert {
  static constexpr std::string_view name = "lambert";
  double mu_db = -27.0;  ///< 10·log₁₀ μ [dB]

  void describe(auto&& field) { field("mu_db", mu_db, Range{-80.0, 0.0}); }

  [[nodiscard]] double cross_section(const ScatterGeometry& g,
                                     double /*frequency*/) const noexcept {
    return power_from_db(mu_db) * std::max(0.0, std::sin(g.grazing_in)) *
           std::max(0.0, std::sin(g.grazing_out));
  }
};
static_assert(ScatteringModel<Lambert>);

}  // namespace asdic
