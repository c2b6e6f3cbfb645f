#include "io/scenario/tracks.h"

#include "core/quantities.h"
#include "core/text.h"

namespace asdic::scenario {

std::vector<Waypoint> read_waypoints(TomlTable& table) {
  std::vector<Waypoint> waypoints;
  for (TomlTable& point : table.tables("waypoints")) {
    const double time = point.number("time", {.noun = "time", .unit = "s"});
    if (!waypoints.empty() && time <= waypoints.back().time)
      throw point.fault(
          "time", "a time after the waypoint before it, " + to_text(waypoints.back().time) + " s");
    const Vec3 position = point.vector("position", quantity::coordinate);
    if (!waypoints.empty()) {
      const double speed =
          (position - waypoints.back().position).norm() / (time - waypoints.back().time);
      if (speed > quantity::velocity.high)
        throw point.fault(
            "position",
            "at most " + to_text(quantity::velocity.high) + " m/s from the waypoint before it",
            to_text(speed) + " m/s");
    }
    waypoints.push_back({.time = time, .position = position});
    point.finish();
  }
  if (waypoints.empty()) throw table.fault("waypoints", "at least one { time, position }");
  return waypoints;
}

void exclude(TomlTable& table, const std::string& key, const std::vector<std::string>& others) {
  for (const std::string& other : others)
    if (table.has(other)) throw table.fault(other, "no " + in_quotes(other) + " beside " + key);
}

}  // namespace asdic::scenario
