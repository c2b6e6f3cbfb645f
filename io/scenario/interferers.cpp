#include "core/quantities.h"
#include "io/scenario/columns.h"
#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"

namespace asdic::scenario {
namespace {

void read_broadband(TomlTable& table, const std::filesystem::path& folder, Interferer& ship) {
  if (table.has("spectrum")) {
    exclude(table, "spectrum", {"level_db", "slope_db_per_decade"});
    TomlTable spectrum = table.table("spectrum");
    const Columns columns = read_columns(
        spectrum, folder, {{"frequency", quantity::frequency}, {"level_db", quantity::level}});
    require_increasing(columns);
    spectrum.finish();
    ship.table = NoiseTable{columns.values[0], columns.values[1]};
  } else if (table.has("level_db")) {
    ship.level_db = table.number("level_db", quantity::level);
    ship.slope_db_per_decade = table.number(
        "slope_db_per_decade", {.noun = "slope", .unit = "dB", .low = -60.0, .high = 20.0},
        ship.slope_db_per_decade);
  }
}

}  // namespace

void read_interferers(std::vector<TomlTable> tables, const std::filesystem::path& folder,
                      Scenario& scenario) {
  for (TomlTable& table : tables) {
    Interferer ship;
    ship.name = read_name(table, "interferer", scenario.interferers, tables.size());
    if (table.has("waypoints")) {
      exclude(table, "waypoints", {"position", "velocity"});
      ship.track.waypoints = read_waypoints(table);
      ship.track.start.position = ship.track.waypoints.front().position;
    } else {
      ship.track.start.position = table.vector("position", quantity::coordinate);
      ship.track.start.velocity = table.vector("velocity", quantity::velocity, Vec3::Zero());
    }
    read_broadband(table, folder, ship);
    for (TomlTable& tonal : table.tables("tonal")) {
      ship.tonals.push_back({.frequency = tonal.number("frequency", quantity::frequency),
                             .level_db = tonal.number("level_db", quantity::level)});
      tonal.finish();
    }
    if (!ship.level_db && !ship.table && ship.tonals.empty())
      throw table.fault("level_db", "a level, a spectrum or a tonal", "none of them");
    table.finish();
    scenario.interferers.push_back(std::move(ship));
  }
}

}  // namespace asdic::scenario
