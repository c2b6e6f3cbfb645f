#include <cmath>
#include <limits>

#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"

namespace asdic::scenario {

void read_targets(std::vector<TomlTable> tables, Scenario& scenario) {
  for (TomlTable& table : tables) {
    Target target;
    target.name = read_name(table, "target", scenario.targets, tables.size());
    if (table.has("waypoints")) {
      exclude(table, "waypoints", {"position", "velocity", "range", "bearing_deg", "depth"});
      target.track.waypoints = read_waypoints(table);
      target.track.start.position = target.track.waypoints.front().position;
    } else if (table.has("range")) {
      exclude(table, "range", {"position"});
      const double range =
          table.number("range", {.noun = "range", .unit = "m", .low = 0.0, .high = 1e7});
      const double bearing = radians(
          table.number("bearing_deg",
                       {.noun = "bearing", .unit = "degrees", .low = -360.0, .high = 360.0}, 0.0));
      const Vec3 from = scenario.platforms[0].track.start.position;
      target.track.start.position = {from.x() + range * std::sin(bearing),
                                     from.y() + range * std::cos(bearing),
                                     table.number("depth", depth_quantity)};
    } else {
      exclude(table, "position", {"bearing_deg", "depth"});
      target.track.start.position = table.vector("position", coordinate);
    }
    if (target.track.waypoints.empty())
      target.track.start.velocity = table.vector("velocity", velocity_component, Vec3::Zero());
    target.strength_db = table.number(
        "strength_db", {.noun = "target strength", .unit = "dB", .low = -200.0, .high = 200.0});
    constexpr int most = std::numeric_limits<int>::max();
    target.first_ping = static_cast<int>(table.integer("first_ping", 1, most, 1));
    target.last_ping = static_cast<int>(table.integer("last_ping", 1, most, most));
    if (target.last_ping < target.first_ping)
      throw table.fault("last_ping", "at least first_ping, " + std::to_string(target.first_ping));
    table.finish();
    scenario.targets.push_back(std::move(target));
  }
}

}  // namespace asdic::scenario
