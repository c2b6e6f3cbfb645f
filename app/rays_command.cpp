#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/rays_output.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "raytrace/ocean/depth_in_water.h"
#include "raytrace/ocean/slice.h"
#include "raytrace/propagation.h"

namespace asdic::detail::app {
namespace {

struct RaysOptions {
  ScenarioChoice scenario;
  std::optional<double> from, to;  // [°]
  std::optional<int> count;
  std::vector<double> elevations;               // [°], instead of the three
  std::optional<double> range, depth, bearing;  // [m], [m], [°]
  std::optional<int> bounces;
  bool json = false;
  std::string output;
  bool force = false;

  [[nodiscard]] bool has_fan() const { return from || to || count || !elevations.empty(); }
};

// of a fan that neither the command line nor a run of rays describes
constexpr double usual_from = -20.0, usual_to = 20.0, usual_range = 50e3;  // [°], [°], [m]
constexpr int usual_count = 41, usual_bounces = 100;
constexpr int usual_count_of_run = 50;  // as raytrace/runs/rays_run.cpp

void check(const RaysOptions& options) {
  std::vector<double> given = options.elevations;
  for (const auto& end : {options.from, options.to})
    if (end) given.push_back(*end);
  for (const double elevation : given)
    if (!(std::abs(elevation) < 90.0))
      throw InputError({.where = "--elevations, --from, --to",
                        .got = fmt::format("{} degrees", elevation),
                        .expected = "an angle between -90 and 90 degrees, both excluded"});
  if (options.range && !traced_range.holds(*options.range))
    throw InputError({.where = "--range",
                      .got = fmt::format("{} m", *options.range),
                      .expected = traced_range.expected()});
}

/// Launch elevations [rad]: the command line's, and what it leaves open as [run.fan] has it in a
/// run of rays, else the usual ones.
std::vector<double> elevations(const RaysOptions& options, const BeamSettings& fan, bool as_run) {
  std::vector<double> all;
  for (const double elevation : options.elevations) all.push_back(radians(elevation));
  if (!all.empty()) return all;
  if (as_run && !options.has_fan() && !fan.elevations.empty()) return fan.elevations;
  const int of_run = fan.count > 0 ? fan.count : usual_count_of_run;
  const int count = options.count.value_or(as_run ? of_run : usual_count);
  // in degrees, so that whole ones stay whole
  const double from = options.from.value_or(as_run ? degrees(fan.lowest) : usual_from);
  const double to = options.to.value_or(as_run ? degrees(fan.highest) : usual_to);
  for (int i = 0; i < count; ++i)
    all.push_back(radians(count == 1 ? from : std::lerp(from, to, double(i) / (count - 1))));
  return all;
}

/// Turns a run into the vertical plane through the platform of a sonar scenario along a bearing
/// [deg].
void turn(PropagationCase& run_case, const RaysOptions& options, double bearing) {
  if (!has_sonar(options.scenario.path, options.scenario.overrides))
    throw InputError({.where = "--bearing",
                      .got = fmt::format("{} deg and a run without a platform", bearing),
                      .expected = "a sonar scenario, whose platform is somewhere on the map"});
  const Scenario scenario = read_scenario(options.scenario.path, options.scenario.overrides);
  const Vec3 platform = scenario.platforms[0].track.at(0.0).position;
  run_case.environment =
      ocean_on_map(scenario).plane(platform.head<2>(), radians(bearing), reach_of_area);
  run_case.off_transect = 0.0;
  run_case.on_map = {.x = platform.x(), .y = platform.y(), .bearing = radians(bearing)};
  if (run_case.on_area) run_case.on_area->bearing = radians(bearing);
}

/// The ocean and the source out of a sonar scenario, or one of an ocean and a run.
/// \param as_run  [run] asks for rays: its box and its task stand
RaysResult read(const RaysOptions& options, bool as_run) {
  std::vector<std::string> overrides = options.scenario.overrides, notes;
  if (!as_run) overrides.push_back("run.task=rays");
  if (options.range || !as_run)
    overrides.push_back(fmt::format("run.box_range={}", options.range.value_or(usual_range)));
  RaysResult result;
  result.run_case = read_propagation_case(options.scenario.path, overrides, notes);
  result.origin = {.title = result.run_case.title,
                   .path = options.scenario.path,
                   .text = read_text_file(options.scenario.path, "a scenario file"),
                   .overrides = options.scenario.overrides,
                   .warnings = notes,
                   .origin = result.run_case.origin};
  if (options.bearing) turn(result.run_case, options, *options.bearing);
  std::vector<double>& sources = result.run_case.source_depths;
  if (options.depth)
    sources = {*options.depth};
  else if (!as_run)
    sources = {sources.front()};
  else if (sources.size() > 1 && std::filesystem::path(options.output).extension() != ".ray")
    throw InputError({.where = options.scenario.path + ": run.source.depth",
                      .got = fmt::format("{} depths", sources.size()),
                      .expected = "one, or --source-depth, or -o NAME.ray, which takes all"});
  const Environment& ocean = result.run_case.environment;
  for (const double depth : sources)
    depth_in_water(ocean,
                   options.depth ? "--source-depth" : options.scenario.path + ": run.source.depth",
                   depth);
  return result;
}

std::vector<std::vector<RayPath>> run_of(const PropagationCase& run_case,
                                         const RaysOptions& options) {
  try {
    PropagationResult found;
    until_interrupted([&] {
      found = run(run_case, {}, read_budget(options.scenario.path, options.scenario.overrides));
    });
    for (const std::string& note : found.notes) tell("asdic: note: " + note);
    return std::move(found.rays);
  } catch (const Interrupted&) {
    throw RunError("interrupted");
  } catch (const InputError& error) {
    throw told_of_scenario(error, options.scenario.path, options.scenario.overrides);
  }
}

/// Traces what is asked for. A run of rays or eigenrays goes as `asdic bellhop` goes; a fan of the
/// command line beside a run of eigenrays stands instead of them, and so does a limit of bounces.
RaysResult trace(const RaysOptions& options) {
  const bool asked = asks_for_rays(options.scenario.path, options.scenario.overrides);
  RaysResult result = read(options, asked);
  PropagationCase& run_case = result.run_case;
  if (run_case.dimension == 3) {
    tell(
        "asdic: note: rays are drawn in their vertical plane; run.dimension = 3 is for arrivals "
        "and fields");
    run_case.dimension = 2;
  }
  const bool fan_alone = options.has_fan() || options.bounces;
  if (asked && run_case.task != Task::rays && !fan_alone) {
    run_case.task = Task::eigenrays;
    result.rays_of_source = run_of(run_case, options);
    return result;
  }
  const bool as_run = asked && run_case.task == Task::rays;
  run_case.task = Task::rays;
  const std::vector<double> fan = elevations(options, run_case.beams, as_run);
  if (as_run && !options.bounces) {
    run_case.beams.elevations = fan;
    result.rays_of_source = run_of(run_case, options);
    return result;
  }
  const Environment plane = plane_of(run_case);
  for (const double depth : run_case.source_depths) {
    std::vector<RayPath>& rays = result.rays_of_source.emplace_back();
    for (const double elevation : fan)
      rays.push_back(trace_ray(plane, depth, elevation, run_case.box_range, 50.0,
                               options.bounces.value_or(usual_bounces)));
  }
  return result;
}

int rays(const RaysOptions& options) {
  check(options);
  const OutputRules rules = rules_for(options.output, options.force, options.scenario.path);
  if (!options.output.empty()) {
    check_output(options.output, rules);
    check_kind(options.output, ".ray");
  }
  const RaysResult result = trace(options);
  warn(result.origin.warnings);
  if (!options.output.empty()) write_rays_file(OutputFile(options.output, rules), result);
  if (options.json)
    print(rays_json(result));
  else if (options.output.empty())
    print(rays_table(result));
  return 0;
}

}  // namespace

void add_rays_command(Program& program) {
  program.add_command(
      "rays",
      "Trace a fan of rays from the platform, or from the "
      "source of a run, and tell where they go; a run whose task is "
      "rays or eigenrays is done as it says.",
      [](const Command& command) {
        auto options = std::make_shared<RaysOptions>();
        add_scenario_options(command, options->scenario);
        command
            .add_option(
                "--from", options->from,
                "first elevation, positive up; default: -20, or of a run of rays its own [deg]")
            .type_name("DEG");
        command.add_option("--to", options->to, "last elevation; default: 20, or the run's [deg]")
            .type_name("DEG");
        command.add_option("--count", options->count, "number of rays; default: 41, or the run's")
            .type_name("N")
            .check(between(1, most_traced_rays));
        command
            .add_option("--elevations", options->elevations,
                        "these elevations instead, e.g. --elevations -5,0,5 [deg]")
            .type_name("DEG,...")
            .delimiter(',')
            .one_at_a_time();
        command.add_length(
            "--range", options->range,
            "how far to trace, e.g. 50km; default: 50km, or the box of a run of rays");
        command.add_length(
            "--source-depth", options->depth,
            "depth of the source; default: the platform's at the start, or the run's");
        command
            .add_option(
                "--bearing", options->bearing,
                "true bearing of the rays, where the ocean varies along a transect; default: "
                "along it [deg]")
            .type_name("DEG")
            .check(between(-360.0, 360.0));
        command
            .add_option("--bounces", options->bounces,
                        "end a ray after so many bounces; default: 100, or as a run of rays does")
            .type_name("N")
            .check(between(0, most_traced_bounces));
        command.add_flag("--json", options->json, "print JSON (docs/formats/rays.md)");
        command
            .add_option(
                "-o,--output", options->output,
                "write HDF5 (docs/formats/rays.md), or by its ending .ray, instead of the table")
            .type_name("FILE");
        add_force_option(command, options->force);
        command.footer(
            "Example:  asdic rays scenarios/deep_ocean.toml --from 0 --to 10 --count 11 --range "
            "60km");
        command.runs([options] { return rays(*options); });
      });
}

}  // namespace asdic::detail::app
