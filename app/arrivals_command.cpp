#include <fmt/format.h>

#include <cmath>
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
#include "io/scenario_reader.h"
#include "sonar/echoes/echo.h"
#include "sonar/ping/ping.h"
#include "sonar/scenario/sampling.h"

namespace asdic::app {
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

/// Where the transmitter of a ping is when it sends.
Vec3 source_of(const PingSimulator& simulator, int ping) {
  if (ping > simulator.pings())
    throw InputError({.where = "--ping",
                      .got = std::to_string(ping),
                      .expected = fmt::format("a ping from 1 to {}", simulator.pings())});
  const Transmission& sent = simulator.transmission(ping);
  return transmitter_at(simulator.scenario(), sent.transmitter, sent.time).position;
}

/// From the platform's depth (or another) to any depth and range.
Leg to_receiver(const PingSimulator& simulator, const ArrivalsOptions& options) {
  if (!options.receiver_depth || !options.range)
    throw InputError({.where = options.range ? "--receiver-depth" : "--range",
                      .got = "nothing",
                      .expected = "a length: --receiver-depth and --range go together"});
  const Scenario& scenario = simulator.scenario();
  const Vec3 platform = source_of(simulator, options.ping);
  const PropagationPaths& paths = simulator.paths();
  const double bearing = options.bearing   ? radians(*options.bearing)
                         : paths.layered() ? 0.0
                                           : scenario.transect.bearing;
  const auto plane = paths.solver(paths.plane(platform, bearing));
  const auto in_water = [&](const std::string& option, double depth, double range) {
    const double top = plane->environment().surface.depth_at(range),
                 bottom = plane->environment().bottom.depth_at(range);
    if (depth >= top && depth <= bottom) return depth;
    throw InputError({.where = option,
                      .got = fmt::format("{} m", depth),
                      .expected = fmt::format("a depth between {} and {} m", top, bottom)});
  };
  Leg leg{.bearing = bearing, .range = *options.range};
  const double from = in_water("--source-depth", options.source_depth.value_or(platform.z()), 0.0);
  const double to = in_water("--receiver-depth", *options.receiver_depth, *options.range);
  const double frequency = options.frequency.value_or(simulator.pulse().centre_frequency());
  const Vec3 source(platform.x(), platform.y(), from),
      receiver(platform.x() + *options.range * std::sin(bearing),
               platform.y() + *options.range * std::cos(bearing), to);
  const PathLimits limits =
      limits_of(scenario.propagation, enough_bounces(paths, scenario.propagation, source, receiver,
                                                     frequency, end_of_record(scenario)));
  leg.arrivals = paths.layered() ? paths.find(source, receiver, frequency, limits)
                                 : plane->find(from, to, *options.range, frequency, limits);
  return leg;
}

std::vector<Leg> to_targets(const PingSimulator& simulator, const ArrivalsOptions& options) {
  const Scenario& scenario = simulator.scenario();
  const int n = static_cast<int>(scenario.targets.size());
  if (n == 0)
    throw InputError({.where = options.scenario.path + ": target",
                      .got = "none",
                      .expected = "a target, or --receiver-depth and --range"});
  if (options.target && *options.target >= n)
    throw InputError({.where = "--target",
                      .got = std::to_string(*options.target),
                      .expected = fmt::format("a target from 0 to {}", n - 1)});
  const double c = simulator.paths().speed_at(source_of(simulator, options.ping));
  const Transmission& sent = simulator.transmission(options.ping);
  const Transmitter transmitter = simulator.transmitter(options.ping);
  const double frequency =
      options.frequency.value_or(simulator.pulse(sent.transmitter).centre_frequency());
  const BeamPattern pattern(transmitter, c / frequency, c,
                            platform_heading(scenario, transmitter.platform, sent.time));
  const EchoContext context{.paths = simulator.paths(),
                            .scenario = scenario,
                            .pattern = pattern,
                            .frequency = frequency,
                            .ping_time = sent.time,
                            .transmitter = sent.transmitter,
                            .ping = options.ping,
                            .turn = sent.turn};
  const auto wanted = [&](Leg::Kind kind) {
    const std::string name = kind == Leg::Kind::source_to_target ? "target" : "array";
    return options.legs.empty() ||
           std::find(options.legs.begin(), options.legs.end(), name) != options.legs.end();
  };
  std::vector<Leg> legs;
  for (int i = 0; i < n; ++i) {
    if (options.target && *options.target != i) continue;
    for (Leg& leg : target_echoes(context, i).legs)
      if (wanted(leg.kind)) legs.push_back(std::move(leg));
  }
  return legs;
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
  const Vec3 source = source_of(simulator, options.ping);
  ArrivalsResult result{
      .origin = origin_of(scenario),
      .ping = options.ping,
      .frequency = options.frequency.value_or(simulator.pulse().centre_frequency()),
      .to_receiver = free,
      .receiver_depth = options.receiver_depth.value_or(0.0),
      .legs = free ? std::vector{to_receiver(simulator, options)} : to_targets(simulator, options)};
  result.source_depth = options.source_depth.value_or(source.z());
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
                "of that receiver, where the ocean varies along a transect; default: along it "
                "[deg]")
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

}  // namespace asdic::app
