#include "sonar/noise_spectra/wenz.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/fields.h"
#include "core/quantities.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr double lowest_of_wenz = 1.0;  // of the curves [Hz]

}  // namespace

void WenzNoise::describe(Fields& field) {
  field("shipping", shipping, {.noun = "shipping", .low = 0.0, .high = 1.0},
        "from none to heavy traffic");
  field(inherited("wind_speed", "environment.wind_speed"), wind_speed, quantity::wind_speed,
        "that makes the noise of the surface");
}

double WenzNoise::level_at(double frequency) const noexcept {
  const double f = std::max(frequency, lowest_of_wenz) / 1000.0;
  const double lg_f = std::log10(f);
  const double turbulence = 17.0 - 30.0 * lg_f;
  const double ships = 40.0 + 20.0 * (shipping - 0.5) + 26.0 * lg_f - 60.0 * std::log10(f + 0.03);
  const double wind = 50.0 + 7.5 * std::sqrt(wind_speed) + 20.0 * lg_f - 40.0 * std::log10(f + 0.4);
  return db_from_power(power_from_db(turbulence) + power_from_db(ships) + power_from_db(wind));
}

const Validity& WenzNoise::validity() noexcept {
  static constexpr ValidRange ranges[] = {{"frequency", "Hz", lowest_of_wenz, 1e5}};
  static constexpr Validity validity{"Wenz's noise", "JASA 34, 1936, 1962", ranges};
  return validity;
}

std::string WenzNoise::text() const {
  char text[96];
  std::snprintf(text, sizeof text, "Wenz, shipping %g, wind %g m/s", shipping, wind_speed);
  return text;
}

}  // namespace asdic::detail
