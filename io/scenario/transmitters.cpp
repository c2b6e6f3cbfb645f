#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"

namespace asdic::scenario {
namespace {

/// A vertical line with a taper.
void read_line(TomlTable& table, Transmitter& transmitter) {
  exclude(table, "a vertical line", {"bearing_deg", "bearing_from", "projector", "table"});
  const std::string taper =
      table.choice("taper", {"hann", "rectangular", "omnidirectional"}, "hann");
  transmitter.taper = taper == "hann"          ? Taper::hann
                      : taper == "rectangular" ? Taper::rectangular
                                               : Taper::omnidirectional;
  constexpr Quantity width{.noun = "beamwidth", .unit = "degrees", .low = 0.01, .high = 179.0};
  if (transmitter.taper == Taper::omnidirectional)
    exclude(table, "omnidirectional taper", {"beamwidth_deg"});
  else
    transmitter.beamwidth = radians(table.number("beamwidth_deg", width));
}

void read_projectors(TomlTable& table, Transmitter& transmitter) {
  constexpr Quantity amplitude{.noun = "amplitude", .low = 0.0, .high = 1e6};
  constexpr Quantity phase{.noun = "phase", .unit = "degrees", .low = -360.0, .high = 360.0};
  constexpr Quantity delay{.noun = "delay", .unit = "s", .low = -10.0, .high = 10.0};
  double sum = 0.0;
  for (TomlTable& one : table.tables("projector")) {
    transmitter.projectors.push_back({.offset = one.vector("offset", quantity::coordinate),
                                      .amplitude = one.number("amplitude", amplitude, 1.0),
                                      .phase = radians(one.number("phase_deg", phase, 0.0)),
                                      .delay = one.number("delay", delay, 0.0)});
    sum += transmitter.projectors.back().amplitude;
    one.finish();
  }
  if (transmitter.projectors.empty())
    throw table.fault("projector", "at least one [[transmitter.projector]]", "none");
  if (!(sum > 0.0)) throw table.fault("projector", "an amplitude above 0", "none");
}

BeamTable read_beam_table(TomlTable table) {
  BeamTable beam;
  const auto axis = [&](const std::string& key, const Quantity& quantity,
                        std::vector<double>& into) {
    for (const double angle : table.numbers(key, quantity)) {
      if (!into.empty() && radians(angle) <= into.back())
        throw table.fault(key + "[" + std::to_string(into.size()) + "]",
                          "an angle above the one before it", to_text(angle) + " degrees");
      into.push_back(radians(angle));
    }
  };
  axis("bearing_deg", quantity::bearing.in_degrees(), beam.bearings);
  if (beam.bearings.back() - beam.bearings.front() > 2.0 * pi)
    throw table.fault("bearing_deg", "bearings within one turn");
  axis("elevation_deg", quantity::elevation.in_degrees(), beam.elevations);
  const auto rows = table.rows("level_db", quantity::level);
  if (rows.size() != beam.bearings.size() || rows.front().size() != beam.elevations.size())
    throw table.fault(
        "level_db",
        "a row for each of " + std::to_string(beam.bearings.size()) + " bearings, of " +
            std::to_string(beam.elevations.size()) + " elevations each",
        std::to_string(rows.size()) + " rows of " + std::to_string(rows.front().size()));
  for (const auto& row : rows) beam.level_db.insert(beam.level_db.end(), row.begin(), row.end());
  table.finish();
  return beam;
}

/// Its beam, by `kind`: a vertical line, a list of projectors, a table.
void read_beam(TomlTable& table, Transmitter& transmitter) {
  transmitter.source_level_db = table.number("source_level_db", quantity::level);
  transmitter.elevation =
      radians(table.number("elevation_deg", quantity::elevation.in_degrees(), 0.0));
  const std::string kind = table.choice("kind", {"line", "projectors", "table"}, "line");
  if (kind == "line") {
    read_line(table, transmitter);
    return;
  }
  exclude(table, "kind = \"" + kind + "\"", {"taper", "beamwidth_deg"});
  transmitter.taper = Taper::omnidirectional;
  transmitter.bearing = radians(table.number("bearing_deg", quantity::bearing.in_degrees(), 0.0));
  transmitter.frame = table.choice("bearing_from", {"north", "heading"}, "north") == "north"
                          ? BearingFrame::north
                          : BearingFrame::heading;
  if (kind == "projectors") {
    exclude(table, "kind = \"projectors\"", {"table"});
    read_projectors(table, transmitter);
  } else {
    exclude(table, "kind = \"table\"", {"projector", "elevation_deg", "elevations_deg"});
    transmitter.table = read_beam_table(table.table("table"));
  }
}

/// When it pings, where that is not as [pings] says.
void read_times(TomlTable& table, Transmitter& transmitter) {
  transmitter.first_ping_time =
      table.number("first_ping_time", {.noun = "time", .unit = "s", .low = 0.0, .high = 1e9}, 0.0);
  if (table.has("interval"))
    transmitter.interval = table.number(
        "interval", {.noun = "interval", .unit = "s", .low = 0.0, .high = 1e7, .above = true});
  if (!table.has("elevations_deg")) return;
  exclude(table, "elevations_deg", {"elevation_deg"});
  for (const double elevation : table.numbers("elevations_deg", quantity::elevation.in_degrees()))
    transmitter.elevations.push_back(radians(elevation));
}

}  // namespace

void read_transmitters(std::vector<TomlTable> tables, const std::filesystem::path& folder,
                       Scenario& scenario) {
  scenario.transmitters.clear();
  for (TomlTable& table : tables) {
    Transmitter transmitter;
    transmitter.name = read_name(table, "transmitter", scenario.transmitters, tables.size());
    transmitter.platform = read_reference(table, "platform", scenario.platforms);
    transmitter.offset = table.vector("offset", quantity::coordinate, Vec3::Zero());
    read_times(table, transmitter);
    read_beam(table, transmitter);
    if (table.has("pulse")) transmitter.pulse = read_pulse(table.table("pulse"), folder);
    table.finish();
    scenario.transmitters.push_back(std::move(transmitter));
  }
}

}  // namespace asdic::scenario
