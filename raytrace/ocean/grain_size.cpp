#include <cmath>

#include "core/error.h"
#include "raytrace/ocean/boundary.h"
#include "raytrace/ocean/number_text.h"

namespace asdic::detail {
namespace {

// The three regressions; every interval is closed below and open above.

/// Speed of the sediment over that of the water.
double speed_ratio(double m) noexcept {
  if (m < 1.0) return (0.002709 * m - 0.056452) * m + 1.2778;
  if (m < 5.3) return ((-0.0014881 * m + 0.0213937) * m - 0.1382798) * m + 1.3425;
  return -0.0024324 * m + 1.0019;
}

/// Density of the sediment over that of the water.
double density_ratio(double m) noexcept {
  if (m < 1.0) return (0.007797 * m - 0.17057) * m + 2.3139;
  if (m < 5.3) return ((-0.0165406 * m + 0.2290201) * m - 1.1069031) * m + 3.0455;
  return -0.0012973 * m + 1.1565;
}

/// Attenuation over frequency [dB/(m·kHz)].
double attenuation_ratio(double m) noexcept {
  if (m < 0.0) return 0.4556;
  if (m < 2.6) return 0.4556 + 0.0245 * m;
  if (m < 4.5) return 0.1978 + 0.1245 * m;
  if (m < 6.0) return 8.0399 + m * (-2.5228 + 0.20098 * m);
  return 0.9431 + m * (-0.2041 + 0.0117 * m);
}

}  // namespace

FluidHalfSpace sediment_of_grain_size(double m, double water_speed, double water_density) {
  if (!(m >= -1.0 && m <= 9.0))
    throw InputError({.where = "grain_size",
                      .got = with_unit(m, "phi"),
                      .expected = "a mean grain size from -1 (coarse sand) to 9 phi (clay)"});
  const double speed = speed_ratio(m) * water_speed;
  return {.speed = speed,
          .density = density_ratio(m) * water_density,
          // one wavelength at 1 kHz is speed/1000 metres
          .attenuation_db_per_wavelength = 1e-3 * speed * attenuation_ratio(m)};
}

}  // namespace asdic::detail
