#include <array>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "io/scenario/angles.h"
#include "io/scenario/columns.h"
#include "io/scenario/ocean.h"
#include "io/text/quote.h"
#include "raytrace/ocean/strongest_reflection.h"

namespace asdic::scenario {
namespace {

constexpr double fastest_gas = 500.0;  // of sound in it: air above ice or water is no slip [m/s]

/// One way to say how much a wave loses, and what it comes to.
struct LossUnit {
  const char* key;
  std::string_view unit;
  /// \return dB per wavelength of `value` for a wave of a speed [m/s] at a frequency [Hz]
  double (*db_per_wavelength)(double value, double speed, double frequency);
};

const std::array<LossUnit, 6> loss_units{{
    {"attenuation_db_per_wavelength", "dB per wavelength",
     [](double a, double, double) { return a; }},
    {"attenuation_db_per_metre", "dB/m", [](double a, double c, double f) { return a * c / f; }},
    {"attenuation_db_per_metre_khz", "dB/(m kHz)",
     [](double a, double c, double) { return 1e-3 * a * c; }},
    {"attenuation_nepers_per_metre", "Np/m",
     [](double a, double c, double f) { return db_per_neper * a * c / f; }},
    // α = ω/(2cQ), and α = L·ω/c, over a wavelength c/f
    {"quality_factor", "", [](double q, double, double) { return db_per_neper * pi / q; }},
    {"loss_parameter", "",
     [](double loss, double, double) { return db_per_neper * 2.0 * pi * loss; }},
}};

/// Exactly one of the keys above, each after `prefix` ("shear_"), or none and a default.
double read_loss(TomlTable& table, const std::string& prefix, double speed, double frequency,
                 double fallback) {
  const LossUnit* given = nullptr;
  for (const LossUnit& unit : loss_units) {
    if (!table.has(prefix + unit.key)) continue;
    if (given != nullptr)
      throw table.fault(prefix + unit.key,
                        "one attenuation, not this beside " + in_quotes(prefix + given->key));
    given = &unit;
  }
  if (given == nullptr) return fallback;
  const std::string key = prefix + given->key;
  const bool quality = std::string_view(given->key) == "quality_factor";
  const double value = table.number(key, {.noun = quality ? "quality factor" : "attenuation",
                                          .unit = given->unit,
                                          .low = 0.0,
                                          .above = quality});
  const double loss = given->db_per_wavelength(value, speed, frequency);
  constexpr double most = 50.0;  // a wave that is gone after one wavelength
  if (!(loss <= most))
    throw table.fault(key, "at most " + to_text(most) + " dB per wavelength",
                      to_text(loss) + " dB per wavelength");
  return loss;
}

FluidHalfSpace read_fluid(TomlTable& table, double frequency) {
  FluidHalfSpace fluid;
  fluid.speed = table.number("speed", material_speed, fluid.speed);
  Quantity density = material_density;
  if (fluid.speed < fastest_gas) density.low = 0.1;
  fluid.density = table.number("density", density, fluid.density);
  fluid.attenuation_db_per_wavelength =
      read_loss(table, "", fluid.speed, frequency, fluid.attenuation_db_per_wavelength);
  return fluid;
}

ElasticHalfSpace read_elastic(TomlTable& table, const OceanReading& reading,
                              const WaterAtBoundary& water) {
  ElasticHalfSpace solid;
  const double f = reading.frequency;
  solid.speed = table.number("speed", material_speed, solid.speed);
  solid.shear_speed = table.number(
      "shear_speed", {.noun = "speed", .unit = "m/s", .low = 0.0, .high = 1e5}, solid.shear_speed);
  solid.density = table.number("density", material_density, solid.density);
  solid.attenuation_db_per_wavelength =
      read_loss(table, "", solid.speed, f, solid.attenuation_db_per_wavelength);
  solid.shear_attenuation_db_per_wavelength =
      read_loss(table, "shear_", solid.shear_speed, f, solid.shear_attenuation_db_per_wavelength);
  const StrongestReflection most = strongest_reflection(solid, water);
  if (most.magnitude > most_reflection)
    throw table.fault("kind",
                      "a solid that reflects no more than comes in: attenuation x speed^2 at least "
                      "4/3 of that of its shear waves",
                      "one of reflection coefficient " + to_text(most.magnitude) + " at " +
                          to_text(std::round(10.0 * degrees(most.grazing)) / 10.0) + " degrees");
  // A solid that takes energy in every deformation: Im of its bulk modulus not below 0.
  const double shear =
      4.0 / 3.0 * solid.shear_attenuation_db_per_wavelength * solid.shear_speed * solid.shear_speed;
  if (shear > (1.0 + 1e-9) * solid.attenuation_db_per_wavelength * solid.speed * solid.speed)
    reading.notes.push_back(
        table.where("kind") +
        ": its shear waves lose so much more than its compressional waves that squeezing it would "
        "give energy; beside other water it may reflect more than comes in");
  return solid;
}

FluidHalfSpace read_grain_size(TomlTable& table, const WaterAtBoundary& water) {
  const double size = table.number(
      "grain_size", {.noun = "mean grain size", .unit = "phi", .low = -1.0, .high = 9.0});
  const double speed = table.number("water_speed", material_speed, water.speed);
  const double density = table.number("water_density", material_density, water.density);
  return sediment_of_grain_size(size, speed, density);
}

ReflectionTable read_reflection(TomlTable& table, const OceanReading& reading) {
  ReflectionTable result;
  constexpr AngleQuantity grazing{.noun = "grazing angle", .low_deg = 0.0, .high_deg = 90.0};
  constexpr AngleQuantity phase{.noun = "phase", .low_deg = -36000.0, .high_deg = 36000.0};
  constexpr Quantity magnitude{.noun = "magnitude", .low = 0.0, .high = 1.0};
  if (table.has("file")) {
    const CsvTable csv = read_csv_of(table, reading.folder);
    result.grazing = csv.column("grazing_deg");
    result.magnitude = csv.column("magnitude");
    result.phase = csv.has("phase_deg") ? csv.column("phase_deg")
                                        : std::vector<double>(result.grazing.size(), 0.0);
    for (std::size_t i = 0; i < result.grazing.size(); ++i) {
      const auto fault = [&](const char* name, double got, const std::string& expected) {
        return InputError({.where = csv.file + ":" + std::to_string(csv.lines[i]) + ": " + name,
                           .got = to_text(got),
                           .expected = expected});
      };
      if (!(result.grazing[i] >= 0.0 && result.grazing[i] <= 90.0))
        throw fault("grazing_deg", result.grazing[i], "a grazing angle from 0 to 90 degrees");
      if (i > 0 && result.grazing[i] <= result.grazing[i - 1])
        throw fault("grazing_deg", result.grazing[i], "an angle above the one before it");
      if (result.magnitude[i] > 1.0 && result.magnitude[i] <= most_reflection)
        result.magnitude[i] = 1.0;
      if (!magnitude.holds(result.magnitude[i]))
        throw fault("magnitude", result.magnitude[i], magnitude.expected());
      result.grazing[i] = radians(result.grazing[i]);
      result.phase[i] = radians(result.phase[i]);
    }
    return result;
  }
  result.grazing = read_angles(table, "grazing", grazing);
  result.magnitude = table.numbers("magnitude", magnitude);
  const std::size_t n = result.grazing.size();
  if (has_angle(table, "phase"))
    result.phase = read_angles(table, "phase", phase);
  else
    result.phase.assign(n, 0.0);
  for (const auto& [key, size] : {std::pair{std::string("magnitude"), result.magnitude.size()},
                                  std::pair{angle_key(table, "phase"), result.phase.size()}})
    if (size != n) throw table.fault(key, "as many values as angles, " + std::to_string(n));
  for (std::size_t i = 1; i < n; ++i)
    if (result.grazing[i] <= result.grazing[i - 1])
      throw table.fault(angle_key(table, "grazing") + "[" + std::to_string(i) + "]",
                        "an angle above the one before it");
  return result;
}

}  // namespace

BoundaryMaterial read_material(TomlTable& table, const OceanReading& reading,
                               const WaterAtBoundary& water, std::optional<std::string> fallback) {
  const std::string kind = table.choice(
      "kind", {"vacuum", "rigid", "fluid", "elastic", "grain-size", "table"}, std::move(fallback));
  if (kind == Vacuum::name) return Vacuum{};
  if (kind == Rigid::name) return Rigid{};
  if (kind == FluidHalfSpace::name) return read_fluid(table, reading.frequency);
  if (kind == ElasticHalfSpace::name) return read_elastic(table, reading, water);
  if (kind == "grain-size") return read_grain_size(table, water);
  return read_reflection(table, reading);
}

}  // namespace asdic::scenario
