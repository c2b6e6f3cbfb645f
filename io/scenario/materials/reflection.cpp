#include "io/scenario/materials/reflection.h"

#include <utility>

#include "core/quantities.h"
#include "core/text.h"
#include "core/units.h"
#include "io/settings/columns.h"
#include "raytrace/ocean/strongest_reflection.h"

namespace asdic::detail::scenario {
namespace {

constexpr AngleQuantity reflection_phase{.noun = "phase", .low_deg = -36000.0, .high_deg = 36000.0};
constexpr Quantity reflection_magnitude{.noun = "magnitude", .low = 0.0, .high = 1.0};
constexpr Quantity reflection_loss{.noun = "loss", .unit = "dB", .low = 0.0, .high = 300.0};
constexpr Quantity curve_frequency{.noun = "frequency", .unit = "Hz", .low = 1e-3, .high = 1e7};

/// Of the curve before, while a list of them is read.
constexpr std::string_view last_frequency = "curve before.frequency";

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

void check(Fields& field, const ReflectionTable& rows, const char* strength) {
  const std::size_t n = rows.grazing.size();
  for (const auto& [key, size] :
       {std::pair{strength, rows.magnitude.size()}, std::pair{"phase_deg", rows.phase.size()}})
    if (size != n) field.fault(key, "as many values as angles, " + std::to_string(n));
  for (std::size_t i = 1; i < n; ++i)
    if (rows.grazing[i] <= rows.grazing[i - 1])
      field.fault("grazing_deg[" + std::to_string(i) + "]", "an angle above the one before it");
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

}  // namespace

void RowsTable::describe(Fields& field) {
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
  check(field, rows, by_loss ? "loss_db" : "magnitude");
}
void CurveTable::describe(Fields& field) {
  field(required("frequency"), frequency, curve_frequency, "of the curve");
  if (field.checks() && frequency <= field.known(last_frequency))
    field.fault("frequency", "a frequency above the one before it");
  field.know(last_frequency, frequency);
  rows.describe(field);
}

void ReflectionForm::describe(Fields& field) {
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"file"}, false))
    field.file(required("file"), file, "a readable CSV file",
               "columns grazing_deg, magnitude or loss_db, perhaps phase_deg and frequency_hz");
  if (const auto way = field.way(ways, {"curve"}, !curves.empty())) {
    field.know(last_frequency, 0.0);
    field("curve", curves, "a curve for each of several frequencies");
    if (field.checks() && curves.empty()) field.fault("curve", "at least one curve");
  }
  if (const auto way = field.otherwise(ways, {"grazing_deg"})) one.describe(field);
}

BoundaryMaterial ReflectionForm::build(const MaterialPlace& place) const {
  if (file.empty() && curves.empty()) return one.rows;
  BoundaryMaterial material = ReflectionCurves{};
  auto& measured = std::get<ReflectionCurves>(material);
  for (const CurveTable& each : curves) {
    measured.frequency.push_back(each.frequency);
    measured.curve.push_back(each.rows.rows);
  }
  if (!file.empty()) material = curves_of(read_csv(file));
  if (const auto* several = std::get_if<ReflectionCurves>(&material)) {
    if (several->curve.empty()) throw place.table.fault("curve", "at least one curve");
    note_frequencies(place.table, place.reading, *several);
  }
  return material;
}

ReflectionForm ReflectionForm::of(const ReflectionTable& rows) { return {.one = {rows}}; }

ReflectionForm ReflectionForm::of(const ReflectionCurves& measured) {
  ReflectionForm form;
  for (std::size_t i = 0; i < measured.curve.size(); ++i)
    form.curves.push_back({measured.frequency[i], {measured.curve[i]}});
  return form;
}

}  // namespace asdic::detail::scenario
