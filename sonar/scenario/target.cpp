#include "sonar/scenario/target.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/fields.h"
#include "core/quantities.h"

namespace asdic::detail {
namespace {

double full_circle(double angle) noexcept {  // [0, 2π)
  const double turn = std::fmod(angle, 2.0 * pi);
  return turn < 0.0 ? turn + 2.0 * pi : turn;
}

}  // namespace

double AspectTable::at(double angle) const noexcept {
  const bool both_sides = aspect.back() <= pi;
  double a = full_circle(angle);
  if (both_sides) a = std::min(a, 2.0 * pi - a);
  const auto above = std::upper_bound(aspect.begin(), aspect.end(), a) - aspect.begin();
  const auto n = static_cast<std::ptrdiff_t>(aspect.size());
  const auto angle_of = [&](std::ptrdiff_t i) { return aspect[static_cast<std::size_t>(i)]; };
  const auto level_of = [&](std::ptrdiff_t i) { return strength_db[static_cast<std::size_t>(i)]; };
  if (above > 0 && above < n) {
    const double share = (a - angle_of(above - 1)) / (angle_of(above) - angle_of(above - 1));
    return std::lerp(level_of(above - 1), level_of(above), share);
  }
  if (both_sides) return above == 0 ? strength_db.front() : strength_db.back();
  const double gap = angle_of(0) + 2.0 * pi - angle_of(n - 1);  // from the last to the first
  if (gap <= 0.0) return strength_db.back();
  const double since = above == 0 ? a + 2.0 * pi - angle_of(n - 1) : a - angle_of(n - 1);
  return std::lerp(level_of(n - 1), level_of(0), since / gap);
}

double heading_of(const Target& target, double time) {
  return target.heading ? *target.heading : target.track.course_at(time).value_or(0.0);
}

Vec3 from_body(const Vec3& offset, double heading) noexcept {
  const double s = std::sin(heading), c = std::cos(heading);
  return {s * offset.x() + c * offset.y(), c * offset.x() - s * offset.y(), offset.z()};
}

double aspect_of(const Vec3& in, const Vec3& out, double heading) noexcept {
  const Vec2 from = -in.head<2>().normalized(), to = out.head<2>().normalized();
  Vec2 bisector = from + to;
  if (bisector.norm() < 1e-6) bisector = from;
  return full_circle(std::atan2(bisector.x(), bisector.y()) - heading);
}

/// The line x + t·d leaves the ellipse |D·x|² = 1, D = diag(2/length, 2/beam), at the larger root
/// of |D(x + t·d)|² = 1; from outside it may cross between two positive roots.
bool hidden(const Hull& hull, const Vec3& offset, double aspect) noexcept {
  const Vec2 scale(2.0 / hull.length, 2.0 / hull.beam);
  const Vec2 x = scale.cwiseProduct(offset.head<2>());
  const Vec2 d = scale.cwiseProduct(Vec2(std::cos(aspect), std::sin(aspect)));
  const double a = d.squaredNorm(), b = x.dot(d), c = x.squaredNorm() - 1.0;
  const double discriminant = b * b - a * c;
  if (discriminant <= 0.0) return false;
  const double root = std::sqrt(discriminant);
  const double enter = std::max(0.0, (-b - root) / a), leave = (-b + root) / a;
  return leave - enter > 0.75 * hull.beam;
}

double strength_db(const Target& target, double aspect) {
  if (target.highlights.empty())
    return target.aspect ? target.aspect->at(aspect) : target.strength_db;
  double power = 0.0;
  for (const Highlight& one : target.highlights)
    if (!target.hull || !hidden(*target.hull, one.offset, aspect))
      power += power_from_db(one.aspect ? one.aspect->at(aspect) : one.strength_db);
  return db_from_power(power);
}

double strength_towards(const Target& target, const Vec3& place, double time) {
  const Vec3 towards = place - target.track.at(time).position;
  return strength_db(target, aspect_of(-towards, towards, heading_of(target, time)));
}

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
  constexpr Quantity axis{.noun = "length", .unit = "m", .low = 1e-3, .high = 2000.0};
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
