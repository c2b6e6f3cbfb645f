#include "sonar/scenario/beams/table_beam.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {
namespace {

/// Where a value lies between the nodes of an axis.
struct Between {
  std::size_t low, high;
  double share;
};

Between between(const std::vector<double>& axis, double value) noexcept {
  const auto above =
      static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), value) - axis.begin());
  if (above == 0) return {0, 0, 0.0};
  if (above == axis.size()) return {above - 1, above - 1, 0.0};
  return {above - 1, above, (value - axis[above - 1]) / (axis[above] - axis[above - 1])};
}

Between between_on_circle(const std::vector<double>& axis, double angle) noexcept {
  double a = std::fmod(angle - axis.front(), 2.0 * pi);
  if (a < 0.0) a += 2.0 * pi;
  a += axis.front();  // from the first node to a turn further
  if (a < axis.back() || axis.size() == 1) return between(axis, a);
  const double gap = axis.front() + 2.0 * pi - axis.back();
  return {axis.size() - 1, 0, gap > 0.0 ? (a - axis.back()) / gap : 0.0};
}

/// Angles that rise.
void describe_axis(Fields& field, std::string_view name, std::vector<double>& angles,
                   const AngleQuantity& quantity, std::string_view help) {
  field(required(name), angles, quantity, help);
  if (!field.checks()) return;
  const std::string key = std::string(name) + "_deg";
  if (angles.empty()) field.fault(key, "an angle at least", "none");
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (angles[i] <= angles[i - 1])
      field.fault(key + "[" + std::to_string(i) + "]", "an angle above the one before it",
                  to_text(1e-9 * std::round(1e9 * degrees(angles[i]))) + " degrees");
}

std::vector<std::vector<double>> rows_of(const std::vector<double>& values, std::size_t columns) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (columns == 0 || i % columns == 0) rows.emplace_back();
    rows.back().push_back(values[i]);
  }
  return rows;
}

}  // namespace

void BeamTable::describe(Fields& field) {
  describe_axis(field, "bearing", bearings, quantity::bearing,
                "of the table's rows, relative to the beam's own, rising");
  if (field.checks() && bearings.back() - bearings.front() > 2.0 * pi)
    field.fault("bearing_deg", "bearings within one turn");
  describe_axis(field, "elevation", elevations, quantity::elevation, "within a row, rising");
  auto rows = rows_of(level_db, elevations.size());
  field(required("level_db"), rows, quantity::level,
        "of each bearing a row, with a level for each elevation, re the source level");
  const bool fits = rows.size() == bearings.size() &&
                    std::all_of(rows.begin(), rows.end(),
                                [&](const auto& row) { return row.size() == elevations.size(); });
  if (field.checks() && !fits)
    field.fault("level_db",
                "a row for each of " + std::to_string(bearings.size()) + " bearings, of " +
                    std::to_string(elevations.size()) + " elevations each",
                std::to_string(rows.size()) + " rows of " +
                    std::to_string(rows.empty() ? 0 : rows.front().size()));
  if (!field.reads()) return;
  level_db.clear();
  for (const auto& row : rows) level_db.insert(level_db.end(), row.begin(), row.end());
}

double BeamTable::level(double bearing, double elevation) const noexcept {
  const Between b = between_on_circle(bearings, bearing), e = between(elevations, elevation);
  const auto node = [&](std::size_t i, std::size_t j) {
    return level_db[i * elevations.size() + j];
  };
  return std::lerp(std::lerp(node(b.low, e.low), node(b.low, e.high), e.share),
                   std::lerp(node(b.high, e.low), node(b.high, e.high), e.share), b.share);
}

void TableBeam::describe(Fields& field) {
  field.excludes("kind = \"table\"", {"taper", "beamwidth_deg"});
  turned.describe(field);
  field.excludes("kind = \"table\"", {"projector", "elevation_deg", "elevations_deg"});
  field("table", table, "level over bearing and elevation");
}

std::string TableBeam::text(double /*elevation*/) const {
  return "beam by a table of " + count_of(table.bearings.size(), "bearing") + " and " +
         count_of(table.elevations.size(), "elevation") + ", turned to " + turned.text();
}

TablePattern::TablePattern(BeamTable table, double turned)
    : table_(std::move(table)), turned_(turned) {}

std::complex<double> TablePattern::towards(double bearing, double elevation) const noexcept {
  return amplitude_from_db(table_.level(bearing - turned_, elevation));
}

}  // namespace asdic::detail
