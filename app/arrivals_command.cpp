#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "app/arrivals_output.h"
#include "app/command.h"
#include "app/console.h"
#include "app/output.h"
#include "app/run_arrivals.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/ping/asked_arrivals.h"

namespace asdic::detail::app {
namespace {

struct ArrivalsOptions {
  ScenarioChoice scenario;
  std::vector<std::string> legs;  // "target", "array"; both when empty
  std::optional<int> target;      // from 0
  int ping = 1;
  std::optional<double> source_depth, receiver_depth, range, frequency;
  std::optional<double> bearing;  // [°]
  bool json = false, force = false;
  std::string output;
};

/// The same of a receiver, whose depth is --receiver-depth.
InputError told_of_receiver(const InputError& error) {
  InputFault fault = error.fault();
  if (fault.where == "depth") fault.where = "receiver_depth";
  return told_of_option(InputError(std::move(fault)));
}

/// From the platform's depth (or another) to any depth and range.
Leg to_receiver(const PingSimulator& simulator, const ArrivalsOptions& options) {
  if (!options.receiver_depth || !options.range)
    throw InputError({.where = options.range ? "--receiver-depth" : "--range",
                      .got = "nothing",
                      .expected = "a length: --receiver-depth and --range go together"});
  AskedReceiver asked{.range = *options.range,
                      .depth = *options.receiver_depth,
                      .source_depth = options.source_depth,
                      .frequency = options.frequency};
  if (options.bearing) asked.bearing = radians(*options.bearing);
  try {
    return leg_to(simulator, options.ping, asked);
  } catch (const InputError& error) {
    throw told_of_receiver(error);
  }
}

std::vector<Leg> to_targets(const PingSimulator& simulator, const ArrivalsOptions& options) {
  const int n = static_cast<int>(simulator.scenario().targets.size());
  if (n == 0)
    throw InputError({.where = options.scenario.path + ": target",
                      .got = "none",
                      .expected = "a target, or --receiver-depth and --range"});
  if (options.target && *options.target >= n)
    throw InputError({.where = "--target",
                      .got = std::to_string(*options.target),
                      .expected = fmt::format("a target from 0 to {}", n - 1)});
  const auto wanted = [&](Leg::Kind kind) {
    const std::string name = kind == Leg::Kind::source_to_target ? "target" : "array";
    return options.legs.empty() ||
           std::find(options.legs.begin(), options.legs.end(), name) != options.legs.end();
  };
  std::vector<Leg> legs =
      legs_of_targets(simulator, options.ping, options.target, options.frequency);
  std::erase_if(legs, [&](const Leg& leg) { return !wanted(leg.kind); });
  return legs;
}

/// Where the ping that was asked for is sent.
Vec3 source_of(const PingSimulator& simulator, const ArrivalsOptions& options) {
  try {
    return detail::source_of(simulator, options.ping);
  } catch (const InputError& error) {
    throw told_of_option(error);
  }
}

/// Of a scenario with [run] and without a sonar: at all its receivers, or at the one asked for.
int arrivals_of_run(const ArrivalsOptions& options) {
  if (!options.legs.empty() || options.target)
    throw InputError({.where = options.scenario.path + ": platform",
                      .got = "none",
                      .expected = "a sonar, for --leg and --target"});
  std::vector<std::string> overrides;
  const auto set = [&](const char* key, const std::optional<double>& value) {
    if (value) overrides.push_back(fmt::format("{}={}", key, *value));
  };
  set("run.source.depth", options.source_depth);
  set("run.receivers.depth", options.receiver_depth);
  set("run.receivers.range", options.range);
  set("run.frequency", options.frequency);
  const OutputRules rules = rules_for(options.output, options.force, options.scenario.path);
  if (!options.output.empty()) {
    check_output(options.output, rules);
    check_kind(options.output, ".arr");
  }
  const RunArrivals found = find_run_arrivals(options.scenario, overrides);
  warn(found.origin.warnings);
  if (!options.output.empty()) write_run_arrivals(OutputFile(options.output, rules), found);
  if (options.json)
    print(run_arrivals_json(found));
  else if (options.output.empty())
    print(run_arrivals_table(found));
  return 0;
}

int arrivals(const ArrivalsOptions& options) {
  if (!has_sonar(options.scenario.path, options.scenario.overrides))
    return arrivals_of_run(options);
  if (!options.output.empty()) check_kind(options.output, "");
  const PingSimulator simulator(read_scenario(options.scenario.path, options.scenario.overrides));
  const Scenario& scenario = simulator.scenario();
  warn(scenario.notes);
  const bool free = options.receiver_depth || options.range;
  const Vec3 source = source_of(simulator, options);
  ArrivalsResult result{
      .origin = origin_of(scenario),
      .ping = options.ping,
      .frequency = options.frequency.value_or(simulator.pulse().centre_frequency()),
      .to_receiver = free,
      .receiver_depth = options.receiver_depth.value_or(0.0),
      .legs = free ? std::vector{to_receiver(simulator, options)} : to_targets(simulator, options)};
  if (std::string lack = ended_early(simulator.paths().memory().ended_searches()); !lack.empty())
    warn({std::move(lack)});
  result.source_depth = options.source_depth.value_or(source.z());
  result.earth = EarthPlaces(scenario.origin, scenario.area.get());
  for (const Target& target : scenario.targets) result.targets.push_back(target.name);
  if (!options.output.empty())
    write_arrivals_file(
        OutputFile(options.output, rules_for(options.output, options.force, options.scenario.path)),
        result);
  if (options.json)
    print(arrivals_json(result));
  else if (options.output.empty())
    print(arrivals_table(result));
  return 0;
}

}  // namespace

void add_arrivals_command(Program& program) {
  program.add_command(
      "arrivals",
      "Every eigenray from the platform to the targets and back, or to any depth and range; of a "
      "scenario with a [run], to all its receivers.",
      [](const Command& command) {
        auto options = std::make_shared<ArrivalsOptions>();
        add_scenario_options(command, options->scenario);
        command
            .add_option("--leg", options->legs,
                        "target: platform to target; array: target to array; default: both")
            .type_name("LEG")
            .one_of({"target", "array"})
            .one_at_a_time();
        command.add_option("--target", options->target, "this target alone, from 0; default: all")
            .type_name("N")
            .check(not_negative());
        command.add_option("--ping", options->ping, "positions of this ping")
            .show_default()
            .type_name("N")
            .check(above_zero());
        command.add_length("--receiver-depth", options->receiver_depth,
                           "depth of a receiver, instead of targets; with --range");
        command.add_length("--range", options->range,
                           "horizontal distance of that receiver, e.g. 30km");
        command.add_length("--source-depth", options->source_depth,
                           "depth of the source, with --range; default: the platform's");
        command
            .add_option(
                "--bearing", options->bearing,
                "true bearing of that receiver, where the ocean varies along a transect; default: "
                "along it [deg]")
            .type_name("DEG")
            .check(between(-360.0, 360.0));
        command
            .add_option("--frequency", options->frequency,
                        "at which losses are told [Hz]; default: the pulse's centre")
            .type_name("HZ")
            .check(above_zero());
        command.add_flag("--json", options->json, "print JSON (docs/formats/arrivals.md)");
        command
            .add_option(
                "-o,--output", options->output,
                "write HDF5 (docs/formats/arrivals.md), of a run by its ending .arr, instead of "
                "the table")
            .type_name("FILE");
        add_force_option(command, options->force);
        command.footer(
            "Levels are re the pressure at 1 m: the negative of the transmission loss.\n"
            "Example:  asdic arrivals scenarios/deep_ocean.toml --leg target\n"
            "          asdic arrivals scenarios/deep_ocean.toml --receiver-depth 125m --range 25km "
            "--json");
        command.runs([options] { return arrivals(*options); });
      });
}

}  // namespace asdic::detail::app
