#pragma once
#include <string_view>

#include "core/units.h"
#include "reverb/scattering/geometry.h"

namespace asdic::detail {

/// A horizontal sheet of water that scatters alike in all directions: σ = s_v·h per unit of its
/// horizontal area, 10·log₁₀ s_v the volume scattering strength S_v [dB re 1 m⁻¹], −70 in strong
/// layers … −95 in the quiet deep; 10·log₁₀ of the sum of all s_v·h is the column strength. Urick,
/// Principles of Underwater Sound (1983), ch. 8.
struct VolumeSheet {
  static constexpr std::string_view name = "volume";
  double strength_db = -80.0;  ///< S_v [dB re 1 m⁻¹]
  double thickness = 1.0;      ///< h [m]

  void describe(Fields& field) {
    field("strength_db", strength_db,
          {.noun = "strength", .unit = "dB", .low = -200.0, .high = 0.0},
          "volume scattering strength");
    field("thickness", thickness, {.noun = "thickness", .unit = "m", .low = 0.0, .high = 1e4},
          "of the sheet");
  }

  [[nodiscard]] double cross_section(const ScatterGeometry& g, double frequency) const noexcept {
    return at(frequency)(sines_of(g));
  }

  /// The law for many directions.
  struct At {
    double sigma = 0.0;  ///< [1/sr]
    [[nodiscard]] double operator()(const ScatterSines& /*any direction*/) const noexcept {
      return sigma;
    }
  };
  [[nodiscard]] At at(double /*frequency*/) const noexcept {
    return {power_from_db(strength_db) * thickness};
  }
};
static_assert(ScatteringModel<VolumeSheet>);

}  // namespace asdic::detail
