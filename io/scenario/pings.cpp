#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"
#include "sonar/signal/pulse.h"

namespace asdic::scenario {

namespace {

/// A number of bounces, or "auto": none.
std::optional<int> read_bounces(TomlTable& table, const std::string& key) {
  if (!table.has(key)) return std::nullopt;
  if (table.is_text(key)) {
    static_cast<void>(table.choice(key, {"auto"}, "auto"));
    return std::nullopt;
  }
  return static_cast<int>(table.integer(key, 0, 1000));
}

}  // namespace

void read_propagation(TomlTable table, Scenario& scenario) {
  PropagationSettings& settings = scenario.propagation;
  settings.max_surface_bounces = read_bounces(table, "max_surface_bounces");
  settings.max_bottom_bounces = read_bounces(table, "max_bottom_bounces");
  settings.max_launch_angle = radians(table.number(
      "max_launch_angle_deg",
      {.noun = "angle", .unit = "degrees", .low = 0.0, .high = 90.0, .above = true}, 90.0));
  settings.direct_blast = table.flag("direct_blast", settings.direct_blast);
  settings.fathometer = table.flag("fathometer", settings.fathometer);
  settings.wide_band = table.choice("band", {"narrow", "wide"}, "narrow") == "wide";
  settings.exact_per_phone = table.flag("exact_per_phone", false);
  settings.diffraction = table.flag("diffraction", settings.diffraction);
  table.finish();
}

namespace {

/// What is recorded: pressure at a rate, or complex baseband about a carrier.
void read_samples(TomlTable& table, PingSchedule& pings) {
  const std::string samples = table.choice("samples", {"pressure", "baseband"}, "pressure");
  pings.samples = samples == "baseband" ? Samples::baseband : Samples::pressure;
  constexpr Quantity rate{
      .noun = "sample rate", .unit = "Hz", .low = 0.0, .high = 1e7, .above = true};
  if (pings.samples == Samples::pressure) {
    exclude(table, "samples = \"pressure\"", {"carrier", "baseband_rate"});
    pings.sample_rate = table.number("sample_rate", rate, pings.sample_rate);
    return;
  }
  exclude(table, "samples = \"baseband\"", {"sample_rate"});
  if (table.has("carrier")) pings.carrier = table.number("carrier", quantity::frequency);
  if (table.has("baseband_rate")) pings.baseband_rate = table.number("baseband_rate", rate);
}

}  // namespace

void read_pings(TomlTable table, bool transmitter_has_elevation, Scenario& scenario) {
  PingSchedule& pings = scenario.pings;
  pings.count = static_cast<int>(table.integer("count", 1, 1'000'000, pings.count));
  pings.interval = table.number(
      "interval", {.noun = "interval", .unit = "s", .low = 0.0, .high = 1e7, .above = true},
      pings.interval);
  if (table.has("elevations_deg")) {
    if (transmitter_has_elevation)
      throw table.fault("elevations_deg", "no elevations_deg beside transmitter.elevation_deg");
    for (const double elevation : table.numbers("elevations_deg", quantity::elevation.in_degrees()))
      pings.elevations.push_back(radians(elevation));
  }
  pings.recording_duration =
      table.number("recording_duration", quantity::duration, pings.recording_duration);
  pings.recording_start =
      table.number("recording_start", {.noun = "time", .unit = "s", .low = 0.0, .high = 1e5}, 0.0);
  read_samples(table, pings);
  pings.continuous = table.flag("continuous", pings.continuous);
  pings.blanking = table.flag("blanking", pings.blanking);
  if (pings.continuous && pings.recording_start > 0.0)
    throw table.fault("recording_start", "0 in a continuous stream, which has no gaps");
  table.finish();
}

void check_intervals(TomlTable& root, const Scenario& scenario) {
  if (scenario.pings.count < 2) return;
  std::vector<TomlTable> transmitters = root.one_or_more("transmitter");
  for (std::size_t t = 0; t < scenario.transmitters.size(); ++t) {
    const double interval = scenario.transmitters[t].interval.value_or(scenario.pings.interval),
                 duration = Pulse(pulse_of(scenario, static_cast<int>(t))).duration();
    if (interval >= duration) continue;
    const TomlTable pings = root.table("pings");
    const TomlTable& table = scenario.transmitters[t].interval ? transmitters[t] : pings;
    throw table.fault("interval",
                      "an interval of at least the pulse's duration, " + to_text(duration) +
                          " s: a projector sends one pulse at a time",
                      to_text(interval) + " s");
  }
}

}  // namespace asdic::scenario
