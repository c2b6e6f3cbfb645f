#include "raytrace/ocean/absorption.h"

#include <algorithm>
#include <cmath>

#include "raytrace/ocean/absorption_validity.h"

namespace asdic::detail {
namespace {

double law(const NoAbsorption& /*none*/, double /*frequency*/) noexcept { return 0.0; }

double law(const Thorp& /*thorp*/, double frequency) noexcept {
  const double khz = 1e-3 * frequency;
  const double f2 = khz * khz;
  return 3.3e-3 + 0.11 * f2 / (1.0 + f2) + 44.0 * f2 / (4100.0 + f2) + 3e-4 * f2;
}

// For about 4 °C, pH 8 and 1 km of depth; Jensen et al. (2011), §1.5.
constexpr ValidRange thorp_ranges[] = {{"frequency", "Hz", 100.0, 5e4}};
constexpr Validity thorp_validity{"Thorp's formula", "JASA 42, 270, 1967", thorp_ranges};

/// One relaxation: its strength A·P at a relaxation frequency f_r adds A·P·f_r·f²/(f_r² + f²).
double relaxation(double strength, double relaxation_khz, double khz) noexcept {
  return strength * relaxation_khz * khz * khz / (relaxation_khz * relaxation_khz + khz * khz);
}

/// JASA 72, 1879 (1982), p. 1886, "Total absorption"; f in kHz, D in m, dB/km.
double law(const FrancoisGarrison& water, double frequency) noexcept {
  const double t = water.temperature, s = water.salinity, d = water.depth;
  const double kelvin = 273.0 + t;
  const double c = 1412.0 + 3.21 * t + 1.19 * s + 0.0167 * d;  // their own sound speed [m/s]
  const double khz = 1e-3 * frequency;

  // Boric acid: A₁, f₁; P₁ = 1.
  const double a1 = 8.86 / c * std::pow(10.0, 0.78 * water.ph - 5.0);
  const double f1 = 2.8 * std::sqrt(s / 35.0) * std::pow(10.0, 4.0 - 1245.0 / kelvin);

  // Magnesium sulphate: A₂, P₂, f₂.
  const double a2 = 21.44 * s / c * (1.0 + 0.025 * t);
  const double p2 = 1.0 - 1.37e-4 * d + 6.2e-9 * d * d;
  const double f2 = 8.17 * std::pow(10.0, 8.0 - 1990.0 / kelvin) / (1.0 + 0.0018 * (s - 35.0));

  // Pure water: A₃, P₃; the cubic in T changes at 20 °C.
  const double a3 = t <= 20.0 ? 4.937e-4 + t * (-2.59e-5 + t * (9.11e-7 - t * 1.50e-8))
                              : 3.964e-4 + t * (-1.146e-5 + t * (1.45e-7 - t * 6.5e-10));
  const double p3 = 1.0 - 3.83e-5 * d + 4.9e-10 * d * d;

  return relaxation(a1, f1, khz) + relaxation(a2 * p2, f2, khz) + a3 * p3 * khz * khz;
}

// Part II, and the limits of reliability of its parts: where magnesium sulphate decides, and above
// 500 kHz, where the water itself does.
constexpr ValidRange francois_garrison_ranges[] = {{"frequency", "Hz", 200.0, 1e6},
                                                   {"temperature", "degC", -2.0, 22.0},
                                                   {"salinity", "psu", 30.0, 35.0},
                                                   {"depth", "m", 0.0, 3500.0}};
constexpr ValidRange francois_garrison_above_500_khz[] = {{"frequency", "Hz", 200.0, 1e6},
                                                          {"temperature", "degC", 0.0, 30.0},
                                                          {"salinity", "psu", 0.0, 40.0},
                                                          {"depth", "m", 0.0, 10000.0}};
constexpr std::string_view francois_garrison_name = "Francois and Garrison's formula";
constexpr std::string_view francois_garrison_source = "JASA 72, 896 and 1879, 1982";

/// JASA 103, 1671 (1998), eqs 4–6; f in kHz, z in km, dB/km.
double law(const AinslieMcColm& water, double frequency) noexcept {
  const double t = water.temperature, s = water.salinity / 35.0, z = 1e-3 * water.depth;
  const double khz = 1e-3 * frequency;
  const double boron = 0.78 * std::sqrt(s) * std::exp(t / 26.0);
  const double magnesium = 42.0 * std::exp(t / 17.0);
  return relaxation(0.106 * std::exp((water.ph - 8.0) / 0.56), boron, khz) +
         relaxation(0.52 * (1.0 + t / 43.0) * s * std::exp(-z / 6.0), magnesium, khz) +
         0.00049 * khz * khz * std::exp(-(t / 27.0 + z / 17.0));
}

// Each varied alone, about 10 degC, 35 psu, pH 8 at the surface; p. 1672.
constexpr ValidRange ainslie_mccolm_ranges[] = {{"frequency", "Hz", 100.0, 1e6},
                                                {"temperature", "degC", -6.0, 35.0},
                                                {"salinity", "psu", 5.0, 50.0},
                                                {"pH", "", 7.7, 8.3},
                                                {"depth", "m", 0.0, 7000.0}};
constexpr Validity ainslie_mccolm_validity{"Ainslie and McColm's formula", "JASA 103, 1671, 1998",
                                           ainslie_mccolm_ranges};

std::optional<Validity> law_validity(const NoAbsorption& /*none*/, double /*frequency*/) {
  return std::nullopt;
}
std::optional<Validity> law_validity(const Thorp& /*thorp*/, double /*frequency*/) {
  return thorp_validity;
}
std::optional<Validity> law_validity(const FrancoisGarrison& /*water*/, double frequency) {
  const bool of_water_itself = frequency > 5e5;
  return Validity{francois_garrison_name, francois_garrison_source,
                  of_water_itself ? std::span<const ValidRange>(francois_garrison_above_500_khz)
                                  : std::span<const ValidRange>(francois_garrison_ranges)};
}
std::optional<Validity> law_validity(const AinslieMcColm& /*water*/, double /*frequency*/) {
  return ainslie_mccolm_validity;
}

}  // namespace

std::optional<Validity> validity(const Absorption& absorption, double frequency) {
  return std::visit([&](const auto& model) { return law_validity(model, frequency); }, absorption);
}

double absorption_db_per_km(const Absorption& absorption, double frequency) noexcept {
  return std::visit([&](const auto& model) { return law(model, std::abs(frequency)); }, absorption);
}

double absorption_db_per_km(const BiologicalLayer& layer, double frequency) noexcept {
  if (frequency == 0.0) return 0.0;
  const double ratio = layer.resonance / frequency;
  const double detuning = 1.0 - ratio * ratio;
  return layer.strength / (detuning * detuning + 1.0 / (layer.quality * layer.quality));
}

}  // namespace asdic::detail
