#include "core/quantities.h"
#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"

namespace asdic::scenario {
namespace {

Track read_track(TomlTable& table) {
  Track track;
  if (table.has("waypoints")) {
    exclude(table, "waypoints", {"position", "velocity"});
    track.waypoints = read_waypoints(table);
    track.start.position = track.waypoints.front().position;
  } else {
    track.start = {.position = table.vector("position", quantity::coordinate),
                   .velocity = table.vector("velocity", quantity::velocity, Vec3::Zero())};
  }
  return track;
}

}  // namespace

void read_platforms(std::vector<TomlTable> tables, Scenario& scenario) {
  scenario.platforms.clear();
  for (TomlTable& table : tables) {
    Platform platform;
    platform.name = read_name(table, "platform", scenario.platforms, tables.size());
    platform.track = read_track(table);
    table.finish();
    scenario.platforms.push_back(std::move(platform));
  }
}

}  // namespace asdic::scenario
