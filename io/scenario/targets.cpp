#include <cmath>
#include <limits>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"
#include "io/settings/reader.h"

namespace asdic::scenario {

namespace {

constexpr Quantity strength_quantity{
    .noun = "target strength", .unit = "dB", .low = -200.0, .high = 200.0};

/// `bow_db`, `beam_db`, `stern_db`, or `angle_deg` and `level_db`.
AspectTable read_aspect(TomlTable table) {
  AspectTable aspect;
  if (table.has("angle_deg")) {
    exclude(table, "angle_deg", {"bow_db", "beam_db", "stern_db"});
    const std::vector<double> angles = table.numbers(
        "angle_deg", {.noun = "aspect", .unit = "degrees", .low = 0.0, .high = 360.0});
    for (std::size_t i = 0; i < angles.size(); ++i) {
      if (i > 0 && angles[i] <= angles[i - 1])
        throw table.fault(
            "angle_deg[" + std::to_string(i) + "]",
            "an aspect above the one before it, " + to_text(angles[i - 1]) + " degrees",
            to_text(angles[i]) + " degrees");
      aspect.aspect.push_back(radians(angles[i]));
    }
    aspect.strength_db = table.numbers("level_db", strength_quantity);
    if (aspect.strength_db.size() != angles.size())
      throw table.fault("level_db", "as many values as angles, " + std::to_string(angles.size()));
  } else {
    aspect.aspect = {0.0, 0.5 * pi, pi};
    for (const char* key : {"bow_db", "beam_db", "stern_db"})
      aspect.strength_db.push_back(table.number(key, strength_quantity));
  }
  table.finish();
  return aspect;
}

Highlight read_highlight(TomlTable table) {
  constexpr Quantity length{.noun = "offset", .unit = "m", .low = -1000.0, .high = 1000.0};
  Highlight highlight;
  const std::vector<double> offset = table.numbers("offset", length);
  if (offset.size() != 3) throw table.fault("offset", "[forward, starboard, down] in m");
  highlight.offset = {offset[0], offset[1], offset[2]};
  if (table.has("aspect")) {
    exclude(table, "aspect", {"strength_db"});
    highlight.aspect = read_aspect(table.table("aspect"));
  } else {
    highlight.strength_db = table.number("strength_db", strength_quantity);
  }
  table.finish();
  return highlight;
}

/// What sends sound back, and how much.
void read_body(TomlTable& table, Target& target) {
  constexpr Quantity axis{.noun = "length", .unit = "m", .low = 0.0, .high = 2000.0, .above = true};
  if (table.has("highlight")) {
    exclude(table, "highlight", {"strength_db", "aspect"});
    for (TomlTable& one : table.tables("highlight"))
      target.highlights.push_back(read_highlight(std::move(one)));
  } else if (table.has("aspect")) {
    exclude(table, "aspect", {"strength_db"});
    target.aspect = read_aspect(table.table("aspect"));
  } else {
    target.strength_db = table.number("strength_db", strength_quantity);
  }
  if (table.has("hull")) {
    TomlTable hull = table.table("hull");
    target.hull = Hull{.length = hull.number("length", axis), .beam = hull.number("beam", axis)};
    hull.finish();
    if (target.highlights.empty())
      throw table.fault("hull", "no \"hull\" without highlights that it could hide");
  }
  if (table.has("heading_deg")) {
    target.heading = radians(table.number("heading_deg", quantity::heading.in_degrees()));
  } else if (!(target.highlights.empty() && !target.aspect) && !target.track.course_at(0.0)) {
    static_cast<void>(
        table.number("heading_deg", quantity::heading.in_degrees()));  // required: it never moves
  }
  target.fluctuation = read_word(table, "fluctuation", target.fluctuation);
  const bool by_scan = target.fluctuation == Fluctuation::swerling_1 ||
                       target.fluctuation == Fluctuation::swerling_3;
  if (by_scan) target.scan_pings = static_cast<int>(table.integer("scan_pings", 1, 1'000'000));
}

}  // namespace

void read_targets(std::vector<TomlTable> tables, Scenario& scenario) {
  for (TomlTable& table : tables) {
    Target target;
    target.name = read_name(table, "target", scenario.targets, tables.size());
    for (const char* key : {"position", "velocity", "range", "bearing_deg", "depth"})
      static_cast<void>(table.has(key));  // whichever say where it is: a typo finds them all
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
                                     table.number("depth", quantity::depth)};
    } else {
      exclude(table, "position", {"bearing_deg", "depth"});
      target.track.start.position = table.vector("position", quantity::coordinate);
    }
    if (target.track.waypoints.empty())
      target.track.start.velocity = table.vector("velocity", quantity::velocity, Vec3::Zero());
    read_body(table, target);
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
