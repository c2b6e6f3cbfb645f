#include "core/units.h"

#include "asdic/units.h"
#include "io/ping/provenance.h"
#include "io/text/measured.h"

namespace asdic {

double radians(double degrees) noexcept { return detail::radians(degrees); }
double degrees(double radians) noexcept { return detail::degrees(radians); }
double power_from_db(double db) noexcept { return detail::power_from_db(db); }
double amplitude_from_db(double db) noexcept { return detail::amplitude_from_db(db); }
double db_from_power(double ratio) noexcept { return detail::db_from_power(ratio); }
double db_from_amplitude(double ratio) noexcept { return detail::db_from_amplitude(ratio); }

std::optional<double> measured(std::string_view text, std::string_view unit) {
  const std::optional<detail::Measured> found = detail::parse_measured(text);
  if (!found || !detail::unit_fits(found->unit, unit)) return std::nullopt;
  return found->value;
}

std::string version() { return detail::program_version(); }
std::string build() { return detail::program_and_build(); }

}  // namespace asdic
