#include <cmath>
#include <limits>
#include <string>

#include "core/fields.h"
#include "core/quantities.h"
#include "sonar/scenario/target.h"

namespace asdic::detail {
namespace {

constexpr Quantity target_strength{
    .noun = "target strength", .unit = "dB", .low = -200.0, .high = 200.0};

/// By waypoints; by range and bearing from the first platform, and depth; or by its position.
void describe_place(Fields& field, Track& track) {
  for (const char* key : {"position", "velocity", "range", "bearing_deg", "depth"})
    static_cast<void>(field.finds(key));  // whichever say where it is: a typo finds them all
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"waypoints"}, !track.waypoints.empty())) {
    field.excludes("waypoints", {"position", "velocity", "range", "bearing_deg", "depth"});
    track.describe_waypoints(field, true);
  }
  if (const auto way = field.way(ways, {"range", "bearing_deg", "depth"}, false)) {
    double range = 0.0, bearing = 0.0, depth = 0.0;
    field(required("range"), range, {.noun = "range", .unit = "m", .low = 0.0, .high = 1e7},
          "from the first platform");
    field("bearing", bearing, quantity::bearing, "true, from there");
    field(required("depth"), depth, quantity::depth, "below the mean surface");
    if (field.reads())
      track.start.position = {field.known("platform[0].east") + range * std::sin(bearing),
                              field.known("platform[0].north") + range * std::cos(bearing), depth};
  }
  if (const auto way = field.otherwise(ways, {"position"}))
    field(live(required("position")), track.start.position, quantity::coordinate, "at the start");
  if (track.waypoints.empty())
    field(live("velocity"), track.start.velocity, quantity::velocity, "from then on");
}

/// Strengths at the bow, abeam and at the stern, for both sides.
void describe_three_aspects(Fields& field, AspectTable& table) {
  table.aspect = {0.0, 0.5 * pi, pi};
  table.strength_db.assign(3, 0.0);
  field(required("bow_db"), table.strength_db[0], target_strength, "at the bow");
  field(required("beam_db"), table.strength_db[1], target_strength, "abeam");
  field(required("stern_db"), table.strength_db[2], target_strength, "at the stern");
}

/// What sends sound back, and how much.
void describe_body(Fields& field, Target& target) {
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"highlight"}, !target.highlights.empty()))
    field("highlight", target.highlights, "places that send sound back");
  if (const auto way = field.way(ways, {"aspect"}, target.aspect.has_value()))
    field("aspect", target.aspect, "strength over aspect");
  if (const auto way = field.otherwise(ways, {"strength_db"}))
    field(live(required("strength_db")), target.strength_db, target_strength, "from all sides");
  field("hull", target.hull, "that hides highlights");
  if (field.checks() && target.hull && target.highlights.empty())
    field.fault("hull", "no \"hull\" without highlights that it could hide");
}

/// Required of a body with sides that never moves.
void describe_heading(Fields& field, Target& target) {
  field(live(by_default("heading", "its course")), target.heading, quantity::heading,
        "true, of the bow; required of a body with aspects or highlights that never moves");
  const bool has_sides = !target.highlights.empty() || target.aspect;
  if (!field.reads() || target.heading || !has_sides || target.track.course_at(0.0)) return;
  double heading = 0.0;
  field(required("heading"), heading, quantity::heading, "");
}

}  // namespace

void AspectTable::describe(Fields& field) {
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"angle_deg"}, true))
    field.columns({{"angle", aspect, AngleQuantity{"aspect", 0.0, 360.0},
                    "rising, from 0 at the bow to starboard"},
                   {"level_db", strength_db, target_strength, "at each angle"}},
                  {});
  if (const auto way = field.otherwise(ways, {"bow_db", "beam_db", "stern_db"}))
    describe_three_aspects(field, *this);
}

void Highlight::describe(Fields& field) {
  field(required("offset"), offset, {.noun = "offset", .unit = "m", .low = -1000.0, .high = 1000.0},
        "from the body's reference point", "[forward, starboard, down]");
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"aspect"}, aspect.has_value()))
    field("aspect", aspect, "strength over aspect");
  if (const auto way = field.otherwise(ways, {"strength_db"}))
    field(required("strength_db"), strength_db, target_strength, "of it alone, from all sides");
}

void Hull::describe(Fields& field) {
  constexpr Quantity axis{.noun = "length", .unit = "m", .low = 0.0, .high = 2000.0, .above = true};
  field(required("length"), length, axis, "from bow to stern");
  field(required("beam"), beam, axis, "from side to side");
}

void Target::describe(Fields& field) {
  field.name(name, "by which others name it");
  describe_place(field, track);
  describe_body(field, *this);
  describe_heading(field, *this);
  field(live("fluctuation"), fluctuation, "how the strength changes from ping to ping");
  if (const auto only = field.only("fluctuation", fluctuation,
                                   {Fluctuation::swerling_1, Fluctuation::swerling_3}))
    field(live(required("scan_pings")), scan_pings, 1, 1'000'000,
          "pings of one transmitter that make a scan, which one draw lasts");
  constexpr int most = std::numeric_limits<int>::max();
  field("first_ping", first_ping, 1, most, "from which it is there");
  field(by_default("last_ping", "no end"), last_ping, 1, most, "to which it is there");
  if (field.checks() && last_ping < first_ping)
    field.fault("last_ping", "at least first_ping, " + std::to_string(first_ping));
}

}  // namespace asdic::detail
