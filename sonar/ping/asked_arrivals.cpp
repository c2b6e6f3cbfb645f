#include "sonar/ping/asked_arrivals.h"

#include <cmath>

#include "core/error.h"
#include "core/quantities.h"
#include "core/text.h"
#include "raytrace/ocean/depth_in_water.h"
#include "raytrace/paths/trace_ray.h"
#include "sonar/echoes/echo.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {

void AskedReceiver::check() const {
  const auto hold = [](const char* what, const std::optional<double>& value, const Quantity& must) {
    if (value && !must.holds(*value))
      throw InputError({.where = what,
                        .got = to_text(*value) + " " + std::string(must.unit),
                        .expected = must.expected()});
  };
  hold("range", range, {.noun = "range", .unit = "m", .low = 0.0, .high = traced_range.high});
  hold("bearing", bearing, {.noun = "bearing", .unit = "rad"});
  hold("frequency", frequency, quantity::frequency);
}

namespace {

/// \throws InputError if there is no such ping
PingGeometry geometry_of(const PingSimulator& simulator, int ping) {
  if (ping < 1 || ping > simulator.pings())
    throw InputError({.where = "ping",
                      .got = std::to_string(ping),
                      .expected = "a ping from 1 to " + std::to_string(simulator.pings())});
  return simulator.geometry(ping);
}

}  // namespace

Vec3 source_of(const PingSimulator& simulator, int ping) {
  return geometry_of(simulator, ping).source().position;
}

Leg leg_to(const PingSimulator& simulator, int ping, const AskedReceiver& receiver) {
  receiver.check();
  return leg_to(simulator, geometry_of(simulator, ping), receiver);
}

std::vector<Leg> legs_of_targets(const PingSimulator& simulator, int ping,
                                 std::optional<int> target, std::optional<double> frequency) {
  return legs_of_targets(simulator, geometry_of(simulator, ping), target, frequency);
}

Leg leg_to(const PingSimulator& simulator, const PingGeometry& geometry,
           const AskedReceiver& receiver) {
  receiver.check();
  const Scenario& scenario = simulator.scenario();
  const Vec3 platform = geometry.source().position;
  const PropagationPaths& paths = simulator.paths();
  const double bearing = receiver.bearing  ? *receiver.bearing
                         : paths.layered() ? 0.0
                                           : scenario.transect.bearing;
  const auto plane = paths.solver(paths.plane(platform, bearing, receiver.range));
  Leg leg{.kind = Leg::Kind::source_to_receiver, .bearing = bearing, .range = receiver.range};
  const double from = depth_in_water(plane->environment(), "source_depth",
                                     receiver.source_depth.value_or(platform.z()));
  const double to = depth_in_water(plane->environment(), "depth", receiver.depth, receiver.range);
  const double frequency = receiver.frequency.value_or(simulator.pulse().centre_frequency());
  const Vec3 source(platform.x(), platform.y(), from),
      end(platform.x() + receiver.range * std::sin(bearing),
          platform.y() + receiver.range * std::cos(bearing), to);
  if (receiver.bearing || !paths.layered()) leg.end = end.head<2>();
  const PathLimits limits = limits_of(
      scenario.propagation,
      enough_bounces(paths, scenario.propagation, source, end, frequency, end_of_record(scenario)));
  leg.arrivals = paths.layered() || paths.volume()
                     ? paths.find(source, end, frequency, limits)
                     : plane->find(from, to, receiver.range, frequency, limits);
  return leg;
}

std::vector<Leg> legs_of_targets(const PingSimulator& simulator, const PingGeometry& geometry,
                                 std::optional<int> target, std::optional<double> frequency) {
  const Scenario& scenario = simulator.scenario();
  const double c = simulator.paths().speed_at(geometry.source().position);
  const Transmitter transmitter = projector_of(scenario, geometry.sent());
  const double f =
      frequency.value_or(simulator.pulse(geometry.sent().transmitter).centre_frequency());
  const BeamPattern pattern(transmitter, c / f, c, geometry.source_heading());
  const EchoContext context{
      .paths = simulator.paths(), .geometry = geometry, .pattern = pattern, .frequency = f};
  std::vector<Leg> legs;
  for (int i = 0; i < static_cast<int>(scenario.targets.size()); ++i) {
    if (target && *target != i) continue;
    for (Leg& leg : target_echoes(context, i).legs) legs.push_back(std::move(leg));
  }
  return legs;
}

}  // namespace asdic::detail
