#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"

namespace asdic::scenario {
namespace {

/// Its beam: a vertical line with a taper.
void read_beam(TomlTable& table, Transmitter& transmitter) {
  transmitter.source_level_db = table.number("source_level_db", level_quantity);
  transmitter.elevation = radians(table.number("elevation_deg", elevation_quantity, 0.0));
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

/// When it pings, where that is not as [pings] says.
void read_times(TomlTable& table, Transmitter& transmitter) {
  transmitter.first_ping_time =
      table.number("first_ping_time", {.noun = "time", .unit = "s", .low = 0.0, .high = 1e9}, 0.0);
  if (table.has("interval"))
    transmitter.interval = table.number(
        "interval", {.noun = "interval", .unit = "s", .low = 0.0, .high = 1e7, .above = true});
  if (!table.has("elevations_deg")) return;
  exclude(table, "elevations_deg", {"elevation_deg"});
  for (const double elevation : table.numbers("elevations_deg", elevation_quantity))
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
    transmitter.offset = table.vector("offset", coordinate, Vec3::Zero());
    read_times(table, transmitter);
    read_beam(table, transmitter);
    if (table.has("pulse")) transmitter.pulse = read_pulse(table.table("pulse"), folder);
    table.finish();
    scenario.transmitters.push_back(std::move(transmitter));
  }
}

}  // namespace asdic::scenario
