#include "asdic/arrivals.h"

#include "core/units.h"
#include "library/physics.h"
#include "library/propagation.h"
#include "sonar/ping/asked_arrivals.h"

namespace asdic {
namespace {

Arrival shown(const detail::Arrival& a) {
  Arrival result{.kind = static_cast<Arrival::Kind>(a.kind),
                 .launch_elevation = a.launch_elevation,
                 .arrival_elevation = a.arrival_elevation,
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

/// Of a scenario that is an ocean and a run.
std::vector<Arrival> arrivals_of_run(const Scenario& scenario, const Receiver& receiver) {
  std::vector<std::string> notes;
  detail::PropagationCase run = run_case_of(scenario, notes);
  run.task = detail::Task::arrivals;
  run.receivers = {.depths = {receiver.depth}, .ranges = {receiver.range}};
  run.source_depths = {receiver.source_depth.value_or(run.source_depths.front())};
  run.frequency = receiver.frequency.value_or(run.frequency);
  return shown(run_of(scenario, run).arrivals.front());
}

}  // namespace

double Arrival::level_db() const noexcept { return detail::db_from_amplitude(std::abs(amplitude)); }

std::vector<Arrival> arrivals(const Scenario& scenario, const Receiver& receiver) {
  return translated([&] {
    if (!detail::has_sonar(Access::data(scenario).document))
      return arrivals_of_run(scenario, receiver);
    return shown(detail::leg_to(Access::physics(scenario).simulator(), receiver.ping,
                                {.range = receiver.range,
                                 .depth = receiver.depth,
                                 .source_depth = receiver.source_depth,
                                 .bearing = receiver.bearing,
                                 .frequency = receiver.frequency})
                     .arrivals);
  });
}

std::vector<Leg> legs(const Scenario& scenario, int ping) {
  return translated([&] {
    std::vector<Leg> result;
    for (const detail::Leg& leg :
         detail::legs_of_targets(Access::physics(scenario).simulator(), ping))
      result.push_back({.kind = leg.kind == detail::Leg::Kind::source_to_target
                                    ? Leg::Kind::source_to_target
                                    : Leg::Kind::target_to_array,
                        .target = leg.target,
                        .array = leg.array,
                        .bearing = leg.bearing,
                        .range = leg.range,
                        .arrivals = shown(leg.arrivals)});
    return result;
  });
}

}  // namespace asdic
