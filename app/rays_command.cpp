#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/output.h"
#include "app/rays_output.h"
#include "core/error.h"
#include "io/scenario/propagation.h"
#include "io/scenario_reader.h"
#include "io/text/csv_table.h"
#include "raytrace/ocean/slice.h"

namespace asdic::app {
namespace {

struct Options {
  ScenarioChoice scenario;
  double from = -20.0, to = 20.0;  // [°]
  int count = 41;
  std::vector<double> elevations;  // [°], instead of the three
  double range = 50e3;
  std::optional<double> depth, bearing;  // [m], [°]
  int bounces = 100;
  bool json = false;
  std::string output;
};

std::vector<double> elevations(const Options& options) {
  std::vector<double> all = options.elevations;
  if (all.empty())
    for (int i = 0; i < options.count; ++i)
      all.push_back(options.count == 1
                        ? options.from
                        : std::lerp(options.from, options.to, double(i) / (options.count - 1)));
  std::vector<double> given = all;
  given.insert(given.end(), {options.from, options.to});  // std::lerp makes a number of NaN
  for (const double elevation : given)
    if (!(std::abs(elevation) < 90.0))
      throw InputError({.where = "--elevations, --from, --to",
                        .got = fmt::format("{} degrees", elevation),
                        .expected = "an angle between -90 and 90 degrees, both excluded"});
  constexpr double longest = 2e7;  // half way round the Earth [m]
  if (!(options.range > 0.0 && options.range <= longest))
    throw InputError({.where = "--range",
                      .got = fmt::format("{} m", options.range),
                      .expected = "a range above 0 m and at most 20000 km"});
  return all;
}

/// The vertical plane through the platform of a sonar scenario along a bearing [deg].
Environment plane_along(const Options& options, double bearing) {
  if (!has_sonar(options.scenario.path, options.scenario.overrides))
    throw InputError({.where = "--bearing",
                      .got = fmt::format("{} deg and a run without a platform", bearing),
                      .expected = "a sonar scenario, whose platform is somewhere on the map"});
  const Scenario scenario = read_scenario(options.scenario.path, options.scenario.overrides);
  const Vec3 platform = scenario.platforms[0].track.at(0.0).position;
  return slice(scenario.environment, scenario.transect.range_of(platform.x(), platform.y()),
               std::cos(radians(bearing) - scenario.transect.bearing));
}

/// The ocean and the source out of a sonar scenario, or one of an ocean and a run.
RaysResult read(const Options& options) {
  std::vector<std::string> overrides = options.scenario.overrides, notes;
  overrides.insert(overrides.end(),
                   {"run.task=rays", fmt::format("run.box_range={}", options.range)});
  RaysResult result;
  result.run_case = read_propagation_case(options.scenario.path, overrides, notes);
  result.origin = {.title = result.run_case.title,
                   .path = options.scenario.path,
                   .text = read_text_file(options.scenario.path, "a scenario file"),
                   .overrides = options.scenario.overrides};
  if (options.bearing) result.run_case.environment = plane_along(options, *options.bearing);
  const Environment& ocean = result.run_case.environment;
  const double depth = options.depth.value_or(result.run_case.source_depths.front());
  const double top = ocean.surface.depth_at(0.0), bottom = ocean.bottom.depth_at(0.0);
  if (!(depth >= top && depth <= bottom))
    throw InputError({.where = "--source-depth",
                      .got = fmt::format("{} m", depth),
                      .expected = fmt::format("a depth between {} and {} m", top, bottom)});
  result.run_case.source_depths = {depth};
  return result;
}

int rays(const Options& options) {
  const std::vector<double> fan = elevations(options);
  RaysResult result = read(options);
  for (const double elevation : fan)
    result.rays.push_back(trace_ray(result.run_case.environment, result.source_depth(),
                                    radians(elevation), options.range, 50.0, options.bounces));
  if (!options.output.empty()) {
    check_output(options.output, options.scenario.path);
    write_rays_file(options.output, result);
  }
  if (options.json)
    print(rays_json(result));
  else if (options.output.empty())
    print(rays_table(result));
  return 0;
}

}  // namespace

void add_rays_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("rays",
                                             "Trace a fan of rays from the platform, or from the "
                                             "source of a run, and tell where they go.");
  add_scenario_options(*command, options->scenario);
  command->add_option("--from", options->from, "first elevation, positive up [deg]")
      ->capture_default_str()
      ->type_name("DEG");
  command->add_option("--to", options->to, "last elevation [deg]")
      ->capture_default_str()
      ->type_name("DEG");
  command->add_option("--count", options->count, "number of rays")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  command
      ->add_option("--elevations", options->elevations,
                   "these elevations instead, e.g. --elevations -5,0,5 [deg]")
      ->type_name("DEG,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_length_option(
      *command, "--range", [options](double x) { options->range = x; },
      "how far to trace, e.g. 50km; default: 50km");
  add_length_option(
      *command, "--source-depth", [options](double x) { options->depth = x; },
      "depth of the source; default: the platform's at the start, or the run's");
  command
      ->add_option("--bearing", options->bearing,
                   "of the rays, where the ocean varies along a transect; default: along it [deg]")
      ->type_name("DEG")
      ->check(CLI::Range(-360.0, 360.0));
  command->add_option("--bounces", options->bounces, "end a ray after so many bounces")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(0, 100000));
  command->add_flag("--json", options->json, "print JSON (docs/formats/rays.md)");
  command
      ->add_option("-o,--output", options->output,
                   "write HDF5 (docs/formats/rays.md), or by its ending .ray, instead of the table")
      ->type_name("FILE");
  command->footer(
      "Example:  asdic rays scenarios/deep_ocean.toml --from 0 --to 10 --count 11 --range 60km");
  command->callback([options, &action] { action = [options] { return rays(*options); }; });
}

}  // namespace asdic::app
