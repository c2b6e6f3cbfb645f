#include "serve/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/quantities.h"
#include "io/scenario/sections.h"
#include "io/text/toml_value.h"
#include "serve/places.h"

namespace asdic::detail::serve {
namespace {

/// How long a straight line goes on: until no ping can be any more, or to where the scenario's
/// coordinates end (there check_places() refuses).
double horizon(const Kinematics& state, double time) {
  double seconds = quantity::time.high - time;
  for (int i = 0; i < 3; ++i)
    if (const double v = state.velocity[i]; v != 0.0)
      seconds = std::min(seconds, (std::copysign(farthest, v) - state.position[i]) / v);
  return seconds;
}

TomlValue waypoint(double time, const Vec3& position) {
  TomlValue point{.data = TomlValue::Table{}, .origin = ""};
  set_key(point, "time", {.data = time, .origin = ""});
  set_key(point, "position", toml_vector(position));
  return point;
}

void forget_motion(TomlValue& table) {
  for (const char* key : {"position", "velocity", "waypoints", "range", "bearing_deg", "depth"})
    erase_key(table, key);
}

/// The horizontal velocity of a course and a speed; the vertical one stays.
Vec3 on_course(TomlTable& wanted, const Vec3& velocity) {
  constexpr Quantity speed{.noun = "speed", .unit = "m/s", .low = 0.0, .high = 100.0};
  const double knots = velocity.head<2>().norm();  // so far [m/s]
  const double course = wanted.has("heading_deg")
                            ? radians(wanted.number("heading_deg", quantity::heading.in_degrees()))
                            : std::atan2(velocity.x(), velocity.y());
  const double v = wanted.number("speed", speed, knots);
  return {v * std::sin(course), v * std::cos(course), velocity.z()};
}

/// Where something was since a time: its turns, and where it was then.
TomlValue::Array past(const Track& track, double since, double until) {
  TomlValue::Array line;
  if (since >= until) return line;
  line.push_back(waypoint(since, track.at(since).position));
  for (const Waypoint& turn : track.waypoints)
    if (turn.time > since && turn.time < until) line.push_back(waypoint(turn.time, turn.position));
  return line;
}

bool has_place(const TomlValue& table) {
  constexpr std::array keys{"position", "waypoints", "range"};
  return std::ranges::any_of(keys, [&](const char* key) { return table.find(key) != nullptr; });
}

/// Whether a track has this place and velocity at a time, to the rounding of decimal numbers, and
/// no turn after it.
bool goes_on(const Track& track, double time, const Kinematics& state) {
  const Kinematics there = track.at(time);
  const double off = (state.position - there.position).norm(),
               faster = (state.velocity - there.velocity).norm();
  if (off > 1e-9 + 1e-14 * state.position.norm() || faster > 1e-12) return false;
  if (track.waypoints.empty() || time >= track.waypoints.back().time) return true;
  const Waypoint& before =
      *(track.waypoints.end() - std::min<std::ptrdiff_t>(2, std::ssize(track.waypoints)));
  const double left = horizon(there, time);
  return before.time <= time && track.waypoints.back().time - time > (1.0 - 1e-9) * left;
}

/// A place and a velocity as the file has them: in a place, or from there on in a straight line,
/// after where it was before.
void set_kinematics(const Kinematics& state, double time, TomlValue::Array line, TomlValue& table) {
  forget_motion(table);
  if (line.empty() && state.velocity.isZero(0.0)) {
    set_key(table, "position", toml_vector(state.position));
    return;
  }
  // A velocity from the scenario's start would lead back to places that were never passed.
  const double on = state.velocity.isZero(0.0) ? 0.0 : horizon(state, time);
  line.push_back(waypoint(time, state.position));
  if (on > 0.0) line.push_back(waypoint(time + on, state.position + on * state.velocity));
  set_key(table, "waypoints", {.data = std::move(line), .origin = ""});
}

}  // namespace

TomlValue toml_vector(const Vec3& v) {
  TomlValue::Array items;
  for (const double x : v) items.push_back({.data = x, .origin = ""});
  return {.data = std::move(items), .origin = ""};
}

bool has_motion(TomlTable& wanted) {
  bool any = false;
  for (const std::string_view key : motion_keys)
    any = wanted.has(std::string(key)) || any;  // each is asked for: then it is a known key
  return any;
}

void set_kinematics(const Kinematics& state, double time, TomlValue& table) {
  set_kinematics(state, time, {}, table);
}

bool set_motion(TomlTable& wanted, const Track& now, const MotionTime& when, TomlValue& table) {
  const double time = when.time;
  TomlValue::Array before;
  if (when.since) before = past(now, *when.since, time);
  if (wanted.has("waypoints")) {
    for (const char* key : {"position", "velocity", "speed"})
      if (wanted.has(key)) throw wanted.fault(key, "none of it beside waypoints");
    TomlValue::Array points = std::move(before);
    for (TomlTable& point : wanted.tables("waypoints")) {
      points.push_back(waypoint(point.number("time", quantity::time),
                                point.vector("position", quantity::coordinate)));
      point.finish();
    }
    forget_motion(table);
    set_key(table, "waypoints", {.data = std::move(points), .origin = ""});
    return true;
  }
  Kinematics state = now.at(time);
  state.position = wanted.vector("position", quantity::coordinate, state.position);
  if (wanted.has("velocity")) {
    for (const char* key : {"heading_deg", "speed"})
      if (wanted.has(key)) throw wanted.fault(key, "none of it beside velocity");
    state.velocity = wanted.vector("velocity", quantity::velocity);
  } else if (wanted.has("heading_deg") || wanted.has("speed")) {
    state.velocity = on_course(wanted, state.velocity);
  }
  if (has_place(table) && goes_on(now, time, state)) return false;
  set_kinematics(state, time, std::move(before), table);
  return true;
}

}  // namespace asdic::detail::serve
