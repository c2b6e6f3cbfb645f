// Part of ocean.h: what is behind a boundary.
#include <array>
#include <cmath>
#include <utility>

#include "core/quantities.h"
#include "core/text.h"
#include "core/units.h"
#include "io/scenario/ocean.h"
#include "io/settings/columns.h"
#include "io/settings/reader.h"
#include "raytrace/ocean/strongest_reflection.h"

namespace asdic::detail::scenario {
namespace {

constexpr double fastest_gas = 500.0;  // of sound in it: air above ice or water is no slip [m/s]

constexpr Quantity shear_speed_quantity{.noun = "speed", .unit = "m/s", .low = 0.0, .high = 1e5};

/// One way to say how much a wave loses, and what it comes to.
struct LossUnit {
  std::string_view key, key_of_shear;
  std::string_view unit, help;
  /// \return dB per wavelength of `value` for a wave of a speed [m/s] at a frequency [Hz]
  double (*db_per_wavelength)(double value, double speed, double frequency);
};

constexpr std::string_view quality_factor = "quality_factor";
const std::array<LossUnit, 6> loss_units{{
    {"attenuation_db_per_wavelength", "shear_attenuation_db_per_wavelength", "dB per wavelength",
     "what the wave loses", [](double a, double, double) { return a; }},
    {"attenuation_db_per_metre", "shear_attenuation_db_per_metre", "dB/m",
     "the same, at the run's frequency", [](double a, double c, double f) { return a * c / f; }},
    {"attenuation_db_per_metre_khz", "shear_attenuation_db_per_metre_khz", "dB/(m kHz)",
     "the same, growing with frequency", [](double a, double c, double) { return 1e-3 * a * c; }},
    {"attenuation_nepers_per_metre", "shear_attenuation_nepers_per_metre", "Np/m",
     "the same, at the run's frequency",
     [](double a, double c, double f) { return db_per_neper * a * c / f; }},
    // α = ω/(2cQ), and α = L·ω/c, over a wavelength c/f
    {quality_factor, "shear_quality_factor", "", "the same, Q = omega/(2 c alpha)",
     [](double q, double, double) { return db_per_neper * pi / q; }},
    {"loss_parameter", "shear_loss_parameter", "", "the same, alpha c/omega",
     [](double loss, double, double) { return db_per_neper * 2.0 * pi * loss; }},
}};

/// What a wave loses: exactly one of the keys above, or none and the default; written as the first.
/// \param shear  whether of the shear wave   \param speed  of the wave
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
           .low = 0.0,
           .above = quality},
          unit.help);
    if (!field.reads() || !value) continue;
    if (!given.empty())
      field.fault(key, "one attenuation, not this beside " + in_quotes(std::string(given)));
    given = key;
    db_per_wavelength = unit.db_per_wavelength(*value, speed, field.known("frequency"));
  }
  constexpr double most = 50.0;  // a wave that is gone after one wavelength
  if (!given.empty() && !(db_per_wavelength <= most))
    field.fault(given, "at most " + to_text(most) + " dB per wavelength",
                to_text(db_per_wavelength) + " dB per wavelength");
}

/// A material without settings.
template <class Material>
struct BareTable {
  static constexpr std::string_view name = Material::name;
  void describe(Fields&) {}
};

struct FluidTable {
  static constexpr std::string_view name = FluidHalfSpace::name;
  FluidHalfSpace fluid = {};

  void describe(Fields& field) {
    field("speed", fluid.speed, quantity::sound_speed, "of sound in it");
    Quantity density = quantity::density;
    if (fluid.speed < fastest_gas) density.low = 0.1;
    field("density", fluid.density, density, "of it");
    describe_loss(field, false, fluid.speed, fluid.attenuation_db_per_wavelength);
  }
};

struct ElasticTable {
  static constexpr std::string_view name = ElasticHalfSpace::name;
  ElasticHalfSpace solid = {};

  void describe(Fields& field) {
    field("speed", solid.speed, quantity::sound_speed, "of compressional waves");
    field("shear_speed", solid.shear_speed, shear_speed_quantity, "of shear waves");
    field("density", solid.density, quantity::density, "of it");
    describe_loss(field, false, solid.speed, solid.attenuation_db_per_wavelength);
    describe_loss(field, true, solid.shear_speed, solid.shear_attenuation_db_per_wavelength);
  }
};

/// A sediment by its mean grain size: a fluid.
struct GrainSizeTable {
  static constexpr std::string_view name = "grain-size";
  double size = 0.0, water_speed = 1500.0, water_density = 1000.0;

  void describe(Fields& field) {
    field(required("grain_size"), size,
          {.noun = "mean grain size", .unit = "phi", .low = -1.0, .high = 9.0}, "of the sediment");
    field(inherited("water_speed", "water.speed"), water_speed, quantity::sound_speed,
          "that the sediment's ratio refers to");
    field(inherited("water_density", "water.density"), water_density, quantity::density,
          "that the sediment's ratio refers to");
  }
};

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

/// One reflection curve: lists of one length.
struct RowsTable {
  ReflectionTable rows = {};

  void describe(Fields& field) {
    field(required("grazing"), rows.grazing, quantity::grazing, "angles of the curve");
    std::vector<double> loss;
    field("loss_db", loss, reflection_loss, "of a reflection, in place of magnitude");
    const SettingKey magnitude = by_default("magnitude", "required without loss_db");
    field(loss.empty() ? required(magnitude) : magnitude, rows.magnitude, reflection_magnitude,
          "of the reflection coefficient");
    field(by_default("phase", "0"), rows.phase, reflection_phase, "of the reflection coefficient");
    if (!field.reads()) return;
    const bool by_loss = rows.magnitude.empty();
    for (const double db : loss)
      if (by_loss) rows.magnitude.push_back(amplitude_from_db(-db));
    if (rows.phase.empty()) rows.phase.assign(rows.grazing.size(), 0.0);
    check(field, by_loss ? "loss_db" : "magnitude");
  }
  void check(Fields& field, const char* strength) const {
    const std::size_t n = rows.grazing.size();
    for (const auto& [key, size] :
         {std::pair{strength, rows.magnitude.size()}, std::pair{"phase_deg", rows.phase.size()}})
      if (size != n) field.fault(key, "as many values as angles, " + std::to_string(n));
    for (std::size_t i = 1; i < n; ++i)
      if (rows.grazing[i] <= rows.grazing[i - 1])
        field.fault("grazing_deg[" + std::to_string(i) + "]", "an angle above the one before it");
  }
};

struct CurveTable {
  double frequency = 0.0;
  RowsTable rows = {};

  void describe(Fields& field) {
    field(required("frequency"), frequency, curve_frequency, "of the curve");
    if (field.checks() && frequency <= field.known(last_frequency))
      field.fault("frequency", "a frequency above the one before it");
    field.know(last_frequency, frequency);
    rows.describe(field);
  }
  static constexpr std::string_view last_frequency = "curve before.frequency";
};

/// One curve, or with frequencies several: [[…curve]], or a file with a column for them.
struct ReflectionForm {
  static constexpr std::string_view name = ReflectionTable::name;
  std::string file = {};
  std::vector<CurveTable> curves = {};
  RowsTable one = {};

  void describe(Fields& field) {
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"file"}, false))
      field.file(required("file"), file, "a readable CSV file",
                 "columns grazing_deg, magnitude or loss_db, perhaps phase_deg and frequency_hz");
    if (const auto way = field.way(ways, {"curve"}, !curves.empty())) {
      field.know(CurveTable::last_frequency, 0.0);
      field("curve", curves, "a curve for each of several frequencies");
      if (field.checks() && curves.empty()) field.fault("curve", "at least one curve");
    }
    if (const auto way = field.otherwise(ways, {"grazing_deg"})) one.describe(field);
  }
};

constexpr Quantity layer_thickness{.noun = "thickness", .unit = "m", .low = 0.0, .high = 1e4};

/// What is known of a layer but its thickness; with shear_speed above 0 it is a solid.
void describe_waves(Fields& field, FloorLayer& layer) {
  field("speed", layer.speed, quantity::sound_speed, "of compressional waves");
  field("density", layer.density, quantity::density, "of it");
  describe_loss(field, false, layer.speed, layer.attenuation_db_per_wavelength);
  field("shear_speed", layer.shear_speed, shear_speed_quantity, "of shear waves; 0: a fluid");
  describe_loss(field, true, layer.shear_speed, layer.shear_attenuation_db_per_wavelength);
  if (!field.checks()) return;
  // A wave that gives no energy back, whatever squeezes or shears the layer.
  const double shear =
      4.0 / 3.0 * layer.shear_attenuation_db_per_wavelength * layer.shear_speed * layer.shear_speed;
  if (shear > (1.0 + 1e-9) * layer.attenuation_db_per_wavelength * layer.speed * layer.speed)
    field.fault("shear_speed",
                "a solid that gives no energy: attenuation x speed^2 at least 4/3 of that of "
                "its shear waves");
}

struct LayerTable {
  FloorLayer layer = {};
  void describe(Fields& field) {
    field(required("thickness"), layer.thickness, layer_thickness, "of the layer");
    describe_waves(field, layer);
  }
};

/// [[…layer]] from the water down, over the half space of the table itself.
struct LayersTable {
  static constexpr std::string_view name = LayeredFloor::name;
  FloorLayer below = {};
  std::vector<LayerTable> layers = {};

  void describe(Fields& field) {
    describe_waves(field, below);
    field("layer", layers, "from the water down, over the half space");
  }
};

/// How a file says what is behind a boundary.
using MaterialForm = std::variant<BareTable<Vacuum>, BareTable<Rigid>, FluidTable, ElasticTable,
                                  GrainSizeTable, ReflectionForm, LayersTable>;

constexpr std::string_view what_kind = "what is behind the boundary";

// The form that has a material's bits.
MaterialForm form_of(const Vacuum&) { return BareTable<Vacuum>{}; }
MaterialForm form_of(const Rigid&) { return BareTable<Rigid>{}; }
MaterialForm form_of(const FluidHalfSpace& fluid) { return FluidTable{fluid}; }
MaterialForm form_of(const ElasticHalfSpace& solid) { return ElasticTable{solid}; }
MaterialForm form_of(const ReflectionTable& rows) { return ReflectionForm{.one = {rows}}; }
MaterialForm form_of(const ReflectionCurves& curves) {
  ReflectionForm form;
  for (std::size_t i = 0; i < curves.curve.size(); ++i)
    form.curves.push_back({curves.frequency[i], {curves.curve[i]}});
  return form;
}
MaterialForm form_of(const LayeredFloor& floor) {
  LayersTable form{.below = floor.below};
  for (const FloorLayer& layer : floor.layers) form.layers.push_back({layer});
  return form;
}

/// Where a form was read, and what is around it.
struct MaterialPlace {
  const TomlTable& table;
  const OceanReading& reading;
  const WaterAtBoundary& water;
};

// The material that a form says.
template <class Material>
BoundaryMaterial build(const BareTable<Material>&, const MaterialPlace&) {
  return Material{};
}
BoundaryMaterial build(const FluidTable& form, const MaterialPlace&) { return form.fluid; }

BoundaryMaterial build(const ElasticTable& form, const MaterialPlace& place) {
  const ElasticHalfSpace& solid = form.solid;
  const StrongestReflection most = strongest_reflection(solid, place.water);
  if (most.magnitude > most_reflection)
    throw place.table.fault(
        "kind",
        "a solid that reflects no more than comes in: attenuation x speed^2 at least "
        "4/3 of that of its shear waves",
        "one of reflection coefficient " + to_text(most.magnitude) + " at " +
            to_text(std::round(10.0 * degrees(most.grazing)) / 10.0) + " degrees");
  // A solid that takes energy in every deformation: Im of its bulk modulus not below 0.
  const double shear =
      4.0 / 3.0 * solid.shear_attenuation_db_per_wavelength * solid.shear_speed * solid.shear_speed;
  if (shear > (1.0 + 1e-9) * solid.attenuation_db_per_wavelength * solid.speed * solid.speed)
    place.reading.notes.push_back(
        place.table.where("kind") +
        ": its shear waves lose so much more than its compressional waves that squeezing it would "
        "give energy; beside other water it may reflect more than comes in");
  return solid;
}

BoundaryMaterial build(const GrainSizeTable& form, const MaterialPlace&) {
  return sediment_of_grain_size(form.size, form.water_speed, form.water_density);
}

BoundaryMaterial build(const LayersTable& form, const MaterialPlace&) {
  LayeredFloor floor{.layers = {}, .below = form.below};
  for (const LayerTable& one : form.layers) floor.layers.push_back(one.layer);
  return floor;
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

/// One curve of a CSV file, or one for each of its frequencies.
BoundaryMaterial curves_of(const CsvTable& csv) {
  ReflectionCurves curves;
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
  return curves;
}

BoundaryMaterial build(const ReflectionForm& form, const MaterialPlace& place) {
  if (form.file.empty() && form.curves.empty()) return form.one.rows;
  BoundaryMaterial material = ReflectionCurves{};
  auto& curves = std::get<ReflectionCurves>(material);
  for (const CurveTable& one : form.curves) {
    curves.frequency.push_back(one.frequency);
    curves.curve.push_back(one.rows.rows);
  }
  if (!form.file.empty()) material = curves_of(read_csv(form.file));
  if (const auto* several = std::get_if<ReflectionCurves>(&material)) {
    if (several->curve.empty()) throw place.table.fault("curve", "at least one curve");
    note_frequencies(place.table, place.reading, *several);
  }
  return material;
}

}  // namespace

BoundaryMaterial read_material(TomlTable& table, const OceanReading& reading,
                               const WaterAtBoundary& water, bool vacuum_unless_given) {
  KnownSettings known{.numbers = {{"frequency", reading.frequency},
                                  {"water.speed", water.speed},
                                  {"water.density", water.density}},
                      .folder = reading.folder};
  MaterialForm form;
  TomlReader(table, known).one_of(vacuum_unless_given ? "kind" : required("kind"), form, what_kind);
  const MaterialPlace place{table, reading, water};
  return std::visit([&](const auto& one) { return build(one, place); }, form);
}

void describe_material(Fields& field, const BoundaryMaterial& material, SettingKey kind) {
  MaterialForm form = std::visit([](const auto& one) { return form_of(one); }, material);
  field.one_of(kind, form, what_kind);
}

}  // namespace asdic::detail::scenario
