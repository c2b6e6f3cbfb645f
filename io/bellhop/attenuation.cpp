#include "io/bellhop/attenuation.h"

#include "core/units.h"

namespace asdic::detail::bellhop {

std::optional<AttenuationUnit> attenuation_unit(char letter) noexcept {
  switch (letter) {
    case 'N':
      return AttenuationUnit::nepers_per_m;
    case 'F':
      return AttenuationUnit::db_per_m_khz;
    case 'M':
      return AttenuationUnit::db_per_m;
    case 'W':
      return AttenuationUnit::db_per_wavelength;
    case 'Q':
      return AttenuationUnit::quality;
    case 'L':
      return AttenuationUnit::loss_parameter;
    default:
      return std::nullopt;
  }
}

double nepers_per_m(AttenuationUnit unit, double value, double speed, double frequency) noexcept {
  const double omega = 2.0 * pi * frequency;
  switch (unit) {
    case AttenuationUnit::nepers_per_m:
      return value;
    case AttenuationUnit::db_per_m:
      return value / db_per_neper;
    case AttenuationUnit::db_per_m_khz:
      return value * frequency / (1000.0 * db_per_neper);
    case AttenuationUnit::db_per_wavelength:
      return value * frequency / (db_per_neper * speed);
    case AttenuationUnit::quality:
      return value == 0.0 ? 0.0 : omega / (2.0 * speed * value);
    case AttenuationUnit::loss_parameter:
      return value * omega / speed;
  }
  return 0.0;
}

double db_per_wavelength(AttenuationUnit unit, double value, double speed,
                         double frequency) noexcept {
  if (unit == AttenuationUnit::db_per_wavelength) return value;
  return nepers_per_m(unit, value, speed, frequency) * db_per_neper * speed / frequency;
}

double true_speed(double speed, double db_per_wavelength) noexcept {
  const double delta = db_per_wavelength / (2.0 * pi * db_per_neper);
  return speed * (1.0 + delta * delta);
}

}  // namespace asdic::detail::bellhop
