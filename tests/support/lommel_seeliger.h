#pragma once
// The example of docs/develop/recipes.md, "A scattering law".
#include <algorithm>
#include <cmath>

#include "core/fields.h"
#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic::detail {

/// Dark rubble, which lights know as Lommel and Seeliger's law:
/// σ = μ·sin θᵢ·sin θₛ/(sin θᵢ + sin θₛ) [1/sr].
struct LommelSeeliger {
  static constexpr std::string_view name = "lommel-seeliger";
  double mu_db = -25.0;  ///< 10·log₁₀ μ [dB]

  void describe(Fields& field) {
    field("mu_db", mu_db, {.noun = "strength", .unit = "dB", .low = -80.0, .high = 0.0},
          "10·log₁₀ μ");
  }

  [[nodiscard]] double cross_section(const ScatterGeometry& g,
                                     double /*frequency*/) const noexcept {
    const double in = std::max(0.0, std::sin(g.grazing_in)),
                 out = std::max(0.0, std::sin(g.grazing_out));
    return in * out > 0.0 ? power_from_db(mu_db) * in * out / (in + out) : 0.0;
  }
  [[nodiscard]] LawByAngles<LommelSeeliger> at(double frequency) const noexcept {
    return {*this, frequency};
  }
};
static_assert(ScatteringModel<LommelSeeliger>);

}  // namespace asdic::detail
