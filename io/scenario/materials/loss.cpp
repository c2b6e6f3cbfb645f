#include "io/scenario/materials/loss.h"

#include <array>

#include "core/text.h"
#include "core/units.h"

namespace asdic::detail::scenario {
namespace {

/// One way to say how much a wave loses, and what it comes to.
struct LossUnit {
  std::string_view key, key_of_shear;
  std::string_view unit;
  double low, high;
  std::string_view help;
  /// \return dB per wavelength of `value` for a wave of a speed [m/s] at a frequency [Hz]
  double (*db_per_wavelength)(double value, double speed, double frequency);
};

constexpr std::string_view quality_factor = "quality_factor";
constexpr double most_per_wavelength = 50.0;  // [dB]; leaves 10⁻⁵ of the energy
const std::array<LossUnit, 6> loss_units{{
    {"attenuation_db_per_wavelength", "shear_attenuation_db_per_wavelength", "dB per wavelength",
     0.0, most_per_wavelength, "what the wave loses", [](double a, double, double) { return a; }},
    {"attenuation_db_per_metre", "shear_attenuation_db_per_metre", "dB/m", 0.0, 1e5,
     "the same, at the run's frequency", [](double a, double c, double f) { return a * c / f; }},
    {"attenuation_db_per_metre_khz", "shear_attenuation_db_per_metre_khz", "dB/(m kHz)", 0.0, 1e3,
     "the same, growing with frequency", [](double a, double c, double) { return 1e-3 * a * c; }},
    {"attenuation_nepers_per_metre", "shear_attenuation_nepers_per_metre", "Np/m", 0.0, 1e4,
     "the same, at the run's frequency",
     [](double a, double c, double f) { return db_per_neper * a * c / f; }},
    // α = ω/(2cQ), and α = L·ω/c, over a wavelength c/f
    {quality_factor, "shear_quality_factor", "", 0.5, 1e9, "the same, Q = omega/(2 c alpha)",
     [](double q, double, double) { return db_per_neper * pi / q; }},
    {"loss_parameter", "shear_loss_parameter", "", 0.0, 1.0, "the same, alpha c/omega",
     [](double loss, double, double) { return db_per_neper * 2.0 * pi * loss; }},
}};

}  // namespace

void describe_loss(Fields& field, bool shear, double speed, double& db_per_wavelength) {
  std::string_view given;
  for (const LossUnit& unit : loss_units) {
    const std::string_view key = shear ? unit.key_of_shear : unit.key;
    const bool quality = unit.key == quality_factor;
    std::optional<double> value;
    if (!field.reads() && &unit == &loss_units.front()) value = db_per_wavelength;
    field(key, value,
          {.noun = quality ? "quality factor" : "attenuation",
           .unit = unit.unit,
           .low = unit.low,
           .high = unit.high},
          unit.help);
    if (!field.reads() || !value) continue;
    if (!given.empty())
      field.fault(key, "one attenuation, not this beside " + in_quotes(std::string(given)));
    given = key;
    db_per_wavelength = unit.db_per_wavelength(*value, speed, field.known("frequency"));
  }
  if (!given.empty() && !(db_per_wavelength <= most_per_wavelength))
    field.fault(given, "at most " + to_text(most_per_wavelength) + " dB per wavelength",
                to_text(db_per_wavelength) + " dB per wavelength");
}

}  // namespace asdic::detail::scenario
