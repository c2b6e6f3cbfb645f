#include <algorithm>
#include <cmath>

#include "io/scenario/sections.h"
#include "io/text/quote.h"
#include "io/wav.h"

namespace asdic::scenario {
namespace {

constexpr Quantity level_quantity{.noun = "level", .unit = "dB", .low = -300.0, .high = 400.0};
constexpr Quantity elevation_quantity{
    .noun = "elevation", .unit = "degrees", .low = -90.0, .high = 90.0};
constexpr Quantity heading_quantity{
    .noun = "heading", .unit = "degrees", .low = -360.0, .high = 360.0};
constexpr Quantity spacing_quantity{
    .noun = "spacing", .unit = "m", .low = 0.0, .high = 1e4, .above = true};

std::vector<Waypoint> read_waypoints(TomlTable& table) {
  std::vector<Waypoint> waypoints;
  for (TomlTable& point : table.tables("waypoints")) {
    const double time = point.number("time", {.noun = "time", .unit = "s"});
    if (!waypoints.empty() && time <= waypoints.back().time)
      throw point.fault(
          "time", "a time after the waypoint before it, " + to_text(waypoints.back().time) + " s");
    const Vec3 position = point.vector("position", coordinate);
    if (!waypoints.empty()) {
      const double speed =
          (position - waypoints.back().position).norm() / (time - waypoints.back().time);
      if (speed > velocity_component.high)
        throw point.fault(
            "position",
            "at most " + to_text(velocity_component.high) + " m/s from the waypoint before it",
            to_text(speed) + " m/s");
    }
    waypoints.push_back({.time = time, .position = position});
    point.finish();
  }
  if (waypoints.empty()) throw table.fault("waypoints", "at least one { time, position }");
  return waypoints;
}

/// Keys that cannot stand beside another one.
void exclude(TomlTable& table, const std::string& key, const std::vector<std::string>& others) {
  for (const std::string& other : others)
    if (table.has(other)) throw table.fault(other, "no " + in_quotes(other) + " beside " + key);
}

}  // namespace

void read_platform(TomlTable table, Scenario& scenario) {
  if (table.has("waypoints")) {
    exclude(table, "waypoints", {"position", "velocity"});
    scenario.platform.waypoints = read_waypoints(table);
    scenario.platform.start.position = scenario.platform.waypoints.front().position;
  } else {
    scenario.platform.start = {
        .position = table.vector("position", coordinate),
        .velocity = table.vector("velocity", velocity_component, Vec3::Zero())};
  }
  table.finish();
}

void read_transmitter(TomlTable table, Scenario& scenario) {
  Transmitter& transmitter = scenario.transmitter;
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
  table.finish();
}

void read_pulse(TomlTable table, const std::filesystem::path& folder, Scenario& scenario) {
  PulseSettings& pulse = scenario.pulse;
  const std::string kind = table.choice("kind", {"cw", "lfm", "hfm", "file"});
  if (kind == "file") {
    pulse.kind = PulseKind::file;
    const std::filesystem::path path = folder / table.text("file");
    if (!std::filesystem::exists(path))
      throw table.fault("file", "a WAV or CSV file of the pulse",
                        "no such file " + in_quotes(path.string()));
    const SampledPulse sampled = read_pulse_file(path);
    pulse.file = path.string();
    pulse.samples = sampled.samples;
    pulse.sample_rate = sampled.sample_rate;
    pulse.duration = static_cast<double>(sampled.samples.size()) / sampled.sample_rate;
    pulse.window = PulseWindow::none;
  } else if (kind == "cw") {
    pulse.kind = PulseKind::cw;
    pulse.frequency = table.number("frequency", frequency_quantity);
  } else {
    pulse.kind = kind == "lfm" ? PulseKind::lfm : PulseKind::hfm;
    pulse.start_frequency = table.number("start_frequency", frequency_quantity);
    pulse.end_frequency = table.number("end_frequency", frequency_quantity);
    if (pulse.start_frequency == pulse.end_frequency)
      throw table.fault("end_frequency", "a frequency other than start_frequency (or kind \"cw\")");
  }
  if (kind != "file") {
    pulse.duration = table.number("duration", duration_quantity);
    const std::string window = table.choice("window", {"none", "hann", "tukey"}, "none");
    pulse.window = window == "hann"    ? PulseWindow::hann
                   : window == "tukey" ? PulseWindow::tukey
                                       : PulseWindow::none;
    if (window == "tukey")
      pulse.tukey_fraction = table.number(
          "tukey_fraction", {.noun = "fraction", .low = 0.0, .high = 1.0}, pulse.tukey_fraction);
  }
  table.finish();
}

void read_array(TomlTable table, Scenario& scenario) {
  const std::string kind = table.choice("kind", {"horizontal", "vertical", "line", "positions"});
  if (kind == "positions") {
    scenario.array.phones = table.vectors("positions", coordinate);
  } else {
    const int phones = static_cast<int>(table.integer("phones", 1, 4096));
    const double spacing = phones == 1 ? table.number("spacing", spacing_quantity, 1.0)
                                       : table.number("spacing", spacing_quantity);
    double heading = 0.0, pitch = 0.0;
    if (kind != "vertical") heading = radians(table.number("heading_deg", heading_quantity, 0.0));
    if (kind == "vertical") pitch = pi / 2.0;
    if (kind == "line")
      pitch = radians(table.number(
          "pitch_deg", {.noun = "pitch", .unit = "degrees", .low = -90.0, .high = 90.0}, 0.0));
    scenario.array = line_array(phones, spacing, heading, pitch);
  }
  scenario.array.offset = table.vector("offset", coordinate, Vec3::Zero());
  table.finish();
}

void read_targets(std::vector<TomlTable> tables, Scenario& scenario) {
  for (std::size_t i = 0; i < tables.size(); ++i) {
    TomlTable& table = tables[i];
    Target target;
    std::string name = "target";
    if (tables.size() > 1) name.append(" ").append(std::to_string(i + 1));
    target.name = table.text("name", name);
    for (const Target& other : scenario.targets)
      if (other.name == target.name) throw table.fault("name", "a name that no other target has");
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
      const Vec3 from = scenario.platform.start.position;
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

void read_noise(TomlTable table, Scenario& scenario) {
  if (table.has("spectral_level_db"))
    scenario.noise.spectral_level_db = table.number("spectral_level_db", level_quantity);
  table.finish();
}

void read_propagation(TomlTable table, Scenario& scenario) {
  PropagationSettings& settings = scenario.propagation;
  settings.max_surface_bounces =
      static_cast<int>(table.integer("max_surface_bounces", 0, 100, settings.max_surface_bounces));
  settings.max_bottom_bounces =
      static_cast<int>(table.integer("max_bottom_bounces", 0, 100, settings.max_bottom_bounces));
  settings.max_launch_angle = radians(table.number(
      "max_launch_angle_deg",
      {.noun = "angle", .unit = "degrees", .low = 0.0, .high = 90.0, .above = true}, 90.0));
  settings.exact_per_phone = table.flag("exact_per_phone", false);
  table.finish();
}

void read_pings(TomlTable table, bool transmitter_has_elevation, Scenario& scenario) {
  PingSchedule& pings = scenario.pings;
  pings.count = static_cast<int>(table.integer("count", 1, 1'000'000, pings.count));
  pings.interval = table.number(
      "interval", {.noun = "interval", .unit = "s", .low = 0.0, .high = 1e7, .above = true},
      pings.interval);
  if (table.has("elevations_deg")) {
    if (transmitter_has_elevation)
      throw table.fault("elevations_deg", "no elevations_deg beside transmitter.elevation_deg");
    for (const double elevation : table.numbers("elevations_deg", elevation_quantity))
      pings.elevations.push_back(radians(elevation));
  }
  pings.recording_duration =
      table.number("recording_duration", duration_quantity, pings.recording_duration);
  pings.recording_start =
      table.number("recording_start", {.noun = "time", .unit = "s", .low = 0.0, .high = 1e5}, 0.0);
  pings.sample_rate = table.number(
      "sample_rate", {.noun = "sample rate", .unit = "Hz", .low = 0.0, .high = 1e7, .above = true},
      pings.sample_rate);
  table.finish();
}

}  // namespace asdic::scenario
