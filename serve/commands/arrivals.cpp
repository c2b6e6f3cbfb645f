#include "serve/commands/arrivals.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/result/result_json.h"
#include "raytrace/parallel/stop.h"
#include "serve/answers.h"
#include "serve/places.h"
#include "serve/refusal.h"
#include "serve/sound_request.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/ping/asked_arrivals.h"

namespace asdic::detail::serve {
namespace {

std::optional<int> target_of(const ArrivalsRequest& asked, const Scenario& scenario) {
  if (asked.target.empty()) return std::nullopt;
  const auto& all = scenario.targets;
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const auto& one) { return one.name == asked.target; });
  if (found == all.end())
    throw Refusal(
        "value", refusal_text("target", in_quotes(asked.target), "the name of one of the targets"));
  return static_cast<int>(found - all.begin());
}

std::vector<Leg> to_targets(const PingSimulator& simulator, const PingGeometry& geometry,
                            const ArrivalsRequest& asked) {
  std::vector<Leg> legs =
      legs_of_targets(simulator, geometry, target_of(asked, simulator.scenario()), asked.frequency);
  std::erase_if(legs, [&](const Leg& leg) {
    const bool outward = leg.kind == Leg::Kind::source_to_target;
    return asked.leg != AskedLegs::both && outward != (asked.leg == AskedLegs::target);
  });
  return legs;
}

Leg to_receiver(const PingSimulator& simulator, const PingGeometry& geometry,
                const ArrivalsRequest& asked) {
  if (!asked.receiver_depth || !asked.range)
    throw Refusal("value", refusal_text(asked.range ? "receiver_depth" : "range", "nothing",
                                        "a length: receiver_depth and range go together"));
  AskedReceiver receiver{.range = *asked.range,
                         .depth = *asked.receiver_depth,
                         .source_depth = asked.source_depth,
                         .frequency = asked.frequency};
  if (asked.bearing_deg) receiver.bearing = radians(*asked.bearing_deg);
  try {
    return leg_to(simulator, geometry, receiver);
  } catch (const InputError& error) {
    const InputFault& fault = error.fault();
    throw Refusal(
        "scenario",
        refusal_text(fault.where == "depth" ? "receiver_depth" : fault.where,
                     fault.where == "depth" || asked.source_depth ? fault.got : "the platform's",
                     fault.expected));
  }
}

}  // namespace

Answer ArrivalsCommand::run(SessionState& session, const Command& command) {
  const auto asked = read_request<ArrivalsRequest>(command.fields);
  const bool free = asked.receiver_depth || asked.range;
  if (!free && (asked.source_depth || asked.bearing_deg))
    throw Refusal("value", refusal_text(asked.source_depth ? "source_depth" : "bearing_deg", "one",
                                        "none without receiver_depth and range"));
  const auto known = session.simulator_of(session.live.state());
  const PingSimulator& simulator = *known;
  const Scenario& scenario = simulator.scenario();
  Transmission sent = session.schedule.next(scenario);
  sent.time = asked.time.value_or(session.now());
  const int number = session.pings + 1;
  check_places(scenario, number, sent.transmitter, sent.time);
  const PingGeometry geometry(scenario, sent, number);
  ArrivalsResult result{.origin = origin_of(scenario),
                        .ping = number,
                        .frequency = asked.frequency.value_or(simulator.pulse().centre_frequency()),
                        .to_receiver = free,
                        .receiver_depth = asked.receiver_depth.value_or(0.0),
                        .legs = free ? std::vector{to_receiver(simulator, geometry, asked)}
                                     : to_targets(simulator, geometry, asked)};
  result.earth = EarthPlaces(scenario.origin, scenario.area.get());
  for (const Target& target : scenario.targets) result.targets.push_back(target.name);
  std::vector<std::string> warnings = scenario.notes;
  if (std::string lack = ended_early(simulator.paths().memory().ended_searches()); !lack.empty())
    warnings.push_back(std::move(lack));
  stop_point();
  return {.line = result_line(command.id, sent.time, arrivals_json(result), warnings)};
}

}  // namespace asdic::detail::serve
