#include <array>
#include <cmath>
#include <utility>

#include "core/quantities.h"
#include "core/text.h"
#include "core/units.h"
#include "io/scenario/angles.h"
#include "io/scenario/columns.h"
#include "io/scenario/ocean.h"
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
  fluid.speed = table.number("speed", quantity::sound_speed, fluid.speed);
  Quantity density = quantity::density;
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
  solid.speed = table.number("speed", quantity::sound_speed, solid.speed);
  solid.shear_speed = table.number(
      "shear_speed", {.noun = "speed", .unit = "m/s", .low = 0.0, .high = 1e5}, solid.shear_speed);
  solid.density = table.number("density", quantity::density, solid.density);
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
  const double speed = table.number("water_speed", quantity::sound_speed, water.speed);
  const double density = table.number("water_density", quantity::density, water.density);
  return sediment_of_grain_size(size, speed, density);
}

constexpr AngleQuantity reflection_phase{.noun = "phase", .low_deg = -36000.0, .high_deg = 36000.0};
constexpr Quantity reflection_magnitude{.noun = "magnitude", .low = 0.0, .high = 1.0};
constexpr Quantity reflection_loss{.noun = "loss", .unit = "dB", .low = 0.0, .high = 300.0};
constexpr Quantity curve_frequency{
    .noun = "frequency", .unit = "Hz", .low = 0.0, .high = 1e7, .above = true};

/// Rows from first to last of a CSV file: grazing_deg, magnitude or loss_db, phase_deg if it has
/// it.
ReflectionTable rows_of_file(const CsvTable& csv, std::size_t first, std::size_t last) {
  const bool by_loss = csv.has("loss_db") && !csv.has("magnitude");
  const char* const strength = by_loss ? "loss_db" : "magnitude";
  const auto angle = csv.column("grazing_deg"), value = csv.column(strength);
  const auto phase =
      csv.has("phase_deg") ? csv.column("phase_deg") : std::vector<double>(angle.size(), 0.0);
  ReflectionTable result;
  for (std::size_t i = first; i < last; ++i) {
    const auto fault = [&](const char* name, double got, const std::string& expected) {
      return InputError({.where = csv.file + ":" + std::to_string(csv.lines[i]) + ": " + name,
                         .got = to_text(got),
                         .expected = expected});
    };
    if (!(angle[i] >= 0.0 && angle[i] <= 90.0))
      throw fault("grazing_deg", angle[i], "a grazing angle from 0 to 90 degrees");
    if (i > first && angle[i] <= angle[i - 1])
      throw fault("grazing_deg", angle[i], "an angle above the one before it");
    if (by_loss && !reflection_loss.holds(value[i]))
      throw fault(strength, value[i], reflection_loss.expected());
    double magnitude = by_loss ? amplitude_from_db(-value[i]) : value[i];
    if (magnitude > 1.0 && magnitude <= most_reflection) magnitude = 1.0;
    if (!reflection_magnitude.holds(magnitude))
      throw fault(strength, value[i], reflection_magnitude.expected());
    result.grazing.push_back(radians(angle[i]));
    result.magnitude.push_back(magnitude);
    result.phase.push_back(radians(phase[i]));
  }
  return result;
}

/// grazing_deg, magnitude or loss_db, phase_deg: arrays of one length.
ReflectionTable read_rows(TomlTable& table) {
  ReflectionTable result;
  result.grazing = read_angles(table, "grazing", quantity::grazing);
  std::string strength = "magnitude";
  if (table.has("loss_db") && !table.has("magnitude")) {
    strength = "loss_db";
    for (const double loss : table.numbers("loss_db", reflection_loss))
      result.magnitude.push_back(amplitude_from_db(-loss));
  } else {
    result.magnitude = table.numbers("magnitude", reflection_magnitude);
  }
  const std::size_t n = result.grazing.size();
  if (has_angle(table, "phase"))
    result.phase = read_angles(table, "phase", reflection_phase);
  else
    result.phase.assign(n, 0.0);
  for (const auto& [key, size] : {std::pair{strength, result.magnitude.size()},
                                  std::pair{angle_key(table, "phase"), result.phase.size()}})
    if (size != n) throw table.fault(key, "as many values as angles, " + std::to_string(n));
  for (std::size_t i = 1; i < n; ++i)
    if (result.grazing[i] <= result.grazing[i - 1])
      throw table.fault(angle_key(table, "grazing") + "[" + std::to_string(i) + "]",
                        "an angle above the one before it");
  return result;
}

/// What is measured at other frequencies than those that the run has.
void note_frequencies(const TomlTable& table, const OceanReading& reading,
                      const ReflectionCurves& curves) {
  const double low = curves.frequency.front(), high = curves.frequency.back();
  if (reading.frequency >= low && reading.frequency <= high) return;
  reading.notes.push_back(table.where("kind") + ": its reflection is given from " + to_text(low) +
                          " to " + to_text(high) + " Hz, and taken to be at " +
                          to_text(reading.frequency) + " Hz what it is at the nearer of them");
}

/// A `table`: one curve, or with frequencies several: [[…curve]], or a file with a column for them.
BoundaryMaterial read_reflection(TomlTable& table, const OceanReading& reading) {
  ReflectionCurves curves;
  if (table.has("file")) {
    const CsvTable csv = read_csv_of(table, reading.folder);
    const std::size_t rows = csv.lines.size();
    if (!csv.has("frequency_hz")) return rows_of_file(csv, 0, rows);
    const auto frequency = csv.column("frequency_hz");
    for (std::size_t first = 0, last = 0; first < rows; first = last) {
      while (last < rows && frequency[last] == frequency[first]) ++last;
      if (!curve_frequency.holds(frequency[first]) ||
          (!curves.frequency.empty() && frequency[first] <= curves.frequency.back()))
        throw InputError(
            {.where = csv.file + ":" + std::to_string(csv.lines[first]) + ": frequency_hz",
             .got = to_text(frequency[first]),
             .expected = "a frequency above 0 Hz and above those before it"});
      curves.frequency.push_back(frequency[first]);
      curves.curve.push_back(rows_of_file(csv, first, last));
    }
  } else if (table.has("curve")) {
    for (TomlTable& one : table.tables("curve")) {
      const double frequency = one.number("frequency", curve_frequency);
      if (!curves.frequency.empty() && frequency <= curves.frequency.back())
        throw one.fault("frequency", "a frequency above the one before it");
      curves.frequency.push_back(frequency);
      curves.curve.push_back(read_rows(one));
      one.finish();
    }
  } else {
    return read_rows(table);
  }
  if (curves.curve.empty()) throw table.fault("curve", "at least one curve");
  note_frequencies(table, reading, curves);
  return curves;
}

/// A wave that gives no energy back, whatever squeezes or shears the layer.
void check_passive(TomlTable& table, const FloorLayer& layer) {
  const double shear =
      4.0 / 3.0 * layer.shear_attenuation_db_per_wavelength * layer.shear_speed * layer.shear_speed;
  if (shear > (1.0 + 1e-9) * layer.attenuation_db_per_wavelength * layer.speed * layer.speed)
    throw table.fault("shear_speed",
                      "a solid that gives no energy: attenuation x speed^2 at least 4/3 of that of "
                      "its shear waves");
}

/// A layer's keys; with shear_speed above 0 it is a solid.
FloorLayer read_layer_waves(TomlTable& table, const OceanReading& reading) {
  FloorLayer layer;
  layer.speed = table.number("speed", quantity::sound_speed, layer.speed);
  layer.density = table.number("density", quantity::density, layer.density);
  layer.shear_speed = table.number(
      "shear_speed", {.noun = "speed", .unit = "m/s", .low = 0.0, .high = 1e5}, layer.shear_speed);
  const double f = reading.frequency;
  layer.attenuation_db_per_wavelength =
      read_loss(table, "", layer.speed, f, layer.attenuation_db_per_wavelength);
  layer.shear_attenuation_db_per_wavelength =
      read_loss(table, "shear_", layer.shear_speed, f, layer.shear_attenuation_db_per_wavelength);
  check_passive(table, layer);
  return layer;
}

/// [[…layer]] from the water down, over the half space of the table itself.
LayeredFloor read_layers(TomlTable& table, const OceanReading& reading) {
  LayeredFloor floor;
  floor.below = read_layer_waves(table, reading);
  constexpr Quantity thickness{.noun = "thickness", .unit = "m", .low = 0.0, .high = 1e4};
  for (TomlTable& one : table.tables("layer")) {
    FloorLayer layer = read_layer_waves(one, reading);
    layer.thickness = one.number("thickness", thickness);
    floor.layers.push_back(layer);
    one.finish();
  }
  return floor;
}

}  // namespace

BoundaryMaterial read_material(TomlTable& table, const OceanReading& reading,
                               const WaterAtBoundary& water, std::optional<std::string> fallback) {
  const std::string kind = table.choice(
      "kind", {"vacuum", "rigid", "fluid", "elastic", "grain-size", "table", "layered"},
      std::move(fallback));
  if (kind == Vacuum::name) return Vacuum{};
  if (kind == Rigid::name) return Rigid{};
  if (kind == FluidHalfSpace::name) return read_fluid(table, reading.frequency);
  if (kind == ElasticHalfSpace::name) return read_elastic(table, reading, water);
  if (kind == "grain-size") return read_grain_size(table, water);
  if (kind == LayeredFloor::name) return read_layers(table, reading);
  return read_reflection(table, reading);
}

}  // namespace asdic::scenario
