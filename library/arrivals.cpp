#include "asdic/arrivals.h"

#include "core/units.h"
#include "library/arguments.h"
#include "library/physics.h"
#include "library/propagation.h"
#include "library/watched.h"
#include "raytrace/area/earth_places.h"
#include "raytrace/ocean/depth_in_water.h"
#include "sonar/ping/asked_arrivals.h"

namespace asdic {
namespace {

Arrival shown(const detail::Arrival& a) {
  Arrival result{.kind = static_cast<Arrival::Kind>(a.kind),
                 .launch_elevation = a.launch_elevation,
                 .arrival_elevation = a.arrival_elevation,
                 .launch_deflection = a.launch_deflection,
                 .arrival_deflection = a.arrival_deflection,
                 .delay = a.delay,
                 .amplitude = a.amplitude,
                 .spreading = a.spreading,
                 .reflection = a.reflection,
                 .scattered = a.scattered,
                 .absorption_db = a.absorption_db,
                 .path_length = a.path_length,
                 .surface_bounces = a.surface_bounces,
                 .bottom_bounces = a.bottom_bounces,
                 .upper_turns = a.upper_turns,
                 .lower_turns = a.lower_turns,
                 .caustics = a.caustics};
  for (const detail::Bounce& bounce : a.bounces)
    result.bounces.push_back({.bottom = bounce.boundary == detail::BoundaryKind::bottom,
                              .grazing = bounce.grazing,
                              .range = bounce.range});
  return result;
}

std::vector<Arrival> shown(const detail::Arrivals& arrivals) {
  std::vector<Arrival> result;
  for (const detail::Arrival& arrival : arrivals) result.push_back(shown(arrival));
  return result;
}

/// Of a scenario that is an ocean and a run: from its source along its transect.
std::vector<Arrival> arrivals_of_run(const Scenario& scenario, const Receiver& receiver) {
  if (receiver.bearing)
    throw InputError("receiver.bearing", "one, and a scenario without a platform",
                     "a sonar, which is somewhere on the map");
  require("receiver.ping", receiver.ping, 1, 1);
  std::vector<std::string> notes;
  detail::PropagationCase run = run_case_of(scenario, notes);
  run.task = detail::Task::arrivals;
  run.source_depths = {detail::depth_in_water(
      run.environment, "source_depth", receiver.source_depth.value_or(run.source_depths.front()))};
  run.receivers = {
      .depths = {detail::depth_in_water(run.environment, "depth", receiver.depth, receiver.range)},
      .ranges = {receiver.range}};
  run.frequency = receiver.frequency.value_or(run.frequency);
  return shown(run_of(scenario, run).arrivals.front());
}

/// A fault of what was asked for, told of the argument that has it: "depth" is "receiver.depth".
detail::InputError told_of_receiver(const detail::InputError& error) {
  for (const char* field : {"range", "depth", "source_depth", "bearing", "frequency", "ping"})
    if (error.fault().where == field) return error.inside("receiver");
  return error;
}

}  // namespace

double Arrival::level_db() const noexcept { return detail::db_from_amplitude(std::abs(amplitude)); }

std::vector<Arrival> arrivals(const Scenario& scenario, const Receiver& receiver,
                              const Watch& watch) {
  return watched(watch, [&] {
    const detail::AskedReceiver asked{.range = receiver.range,
                                      .depth = receiver.depth,
                                      .source_depth = receiver.source_depth,
                                      .bearing = receiver.bearing,
                                      .frequency = receiver.frequency};
    try {
      asked.check();
      if (!detail::has_sonar(Access::data(scenario).document))
        return arrivals_of_run(scenario, receiver);
      return shown(
          detail::leg_to(Access::physics(scenario).simulator(), receiver.ping, asked).arrivals);
    } catch (const detail::InputError& error) {
      throw told_of_receiver(error);
    }
  });
}

std::vector<Leg> legs(const Scenario& scenario, int ping, const Watch& watch) {
  return watched(watch, [&] {
    const detail::PingSimulator& simulator = Access::physics(scenario).simulator();
    const detail::EarthPlaces earth(simulator.scenario().origin, simulator.scenario().area.get());
    std::vector<Leg> result;
    for (const detail::Leg& leg : detail::legs_of_targets(simulator, ping)) {
      const detail::GeographicPlace end = earth.at(leg.end.x(), leg.end.y());
      result.push_back({.kind = leg.kind == detail::Leg::Kind::source_to_target
                                    ? Leg::Kind::source_to_target
                                    : Leg::Kind::target_to_array,
                        .target = leg.target,
                        .array = leg.array,
                        .bearing = leg.bearing,
                        .range = leg.range,
                        .arrivals = shown(leg.arrivals),
                        .latitude = end.latitude,
                        .longitude = end.longitude});
    }
    return result;
  });
}

}  // namespace asdic
