#pragma once
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/quantities.h"
#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic::detail {

/// A measured or computed backscattering strength over grazing angle, of any boundary.
///
///   10·log₁₀σ(θᵢ, θₛ) = ½[S(θᵢ) + S(θₛ)]
///
/// S linear in dB between the rows and held beyond them; nothing scatters at θ = 0. In two angles
/// the law is taken as a product of one factor for each, as Lambert's is: reciprocal, and exact for
/// backscatter. The azimuth and the frequency are ignored.
struct ScatteringTable {
  static constexpr std::string_view name = "table";
  std::vector<double> grazing = {0.5 * pi};   ///< [n ≥ 1] strictly increasing, 0..π/2 [rad]
  std::vector<double> strength_db = {-30.0};  ///< [n] S [dB re 1 m² per m² and sr]

  void describe(Fields& field) {
    field.columns({{"grazing", grazing, quantity::grazing, "rising"},
                   {"strength_db", strength_db, quantity::scattering_strength,
                    "for backscattering at each grazing angle"}},
                  {});
  }

  [[nodiscard]] double cross_section(const ScatterGeometry& g,
                                     double /*frequency*/) const noexcept {
    if (g.grazing_in <= 0.0 || g.grazing_out <= 0.0) return 0.0;
    return power_from_db(0.5 * (strength(g.grazing_in) + strength(g.grazing_out)));
  }
  [[nodiscard]] LawByAngles<ScatteringTable> at(double frequency) const {
    return {*this, frequency};
  }

  /// S [dB]. \param angle  [rad]
  [[nodiscard]] double strength(double angle) const noexcept {
    const auto above = std::upper_bound(grazing.begin(), grazing.end(), angle);
    if (above == grazing.begin()) return strength_db.front();
    if (above == grazing.end()) return strength_db.back();
    const auto i = static_cast<std::size_t>(above - grazing.begin());
    const double share = (angle - grazing[i - 1]) / (grazing[i] - grazing[i - 1]);
    return std::lerp(strength_db[i - 1], strength_db[i], share);
  }
};
static_assert(ScatteringModel<ScatteringTable>);

}  // namespace asdic::detail
