#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/output.h"
#include "app/provenance.h"
#include "core/error.h"
#include "io/ping/growing_table.h"
#include "io/scenario_reader.h"
#include "raytrace/ray_path.h"

namespace asdic::app {
namespace {

struct Options {
  ScenarioChoice scenario;
  double from = -20.0, to = 20.0;  // [°]
  int count = 41;
  std::vector<double> elevations;  // [°], instead of the three
  double range = 50e3;
  std::optional<double> depth;
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
  for (const double elevation : all)
    if (!(std::abs(elevation) < 90.0))
      throw InputError({.where = "--elevations, --from, --to",
                        .got = fmt::format("{} degrees", elevation),
                        .expected = "an angle between -90 and 90 degrees, both excluded"});
  if (!(options.range > 0.0))
    throw InputError({.where = "--range", .got = "0 m", .expected = "a range above 0 m"});
  return all;
}

std::string hits(const RayPath& ray) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, ray.surface_hits.size()); ++i)
    text += (i > 0 ? " " : "") + number(ray.surface_hits[i] / 1000.0, 2);
  return ray.surface_hits.size() > most ? text + " ..." : text;
}

std::string as_table(const std::vector<RayPath>& rays) {
  Table table({{"launch", "deg"},
               {"final", "deg"},
               {"range", "km"},
               {"depth", "m"},
               {"time", "s"},
               {"length", "km"},
               {"surface"},
               {"bottom"},
               {"turns"},
               {"meets the surface at", "km", true}});
  for (const RayPath& ray : rays) {
    const RayPoint& end = ray.points.back();
    table.row({number(degrees(ray.launch_elevation), 3), number(degrees(ray.final_elevation), 3),
               number(end.range / 1000.0, 3), number(end.depth, 1), number(end.time, 4),
               number(ray.path_length / 1000.0, 3), std::to_string(ray.surface_bounces),
               std::to_string(ray.bottom_bounces), std::to_string(ray.turns), hits(ray)});
  }
  return table.text();
}

std::string as_json(const Scenario& scenario, double depth, const std::vector<RayPath>& rays) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const RayPath& ray : rays) {
    nlohmann::ordered_json range, z, time;
    for (const RayPoint& point : ray.points) {
      range.push_back(point.range);
      z.push_back(point.depth);
      time.push_back(point.time);
    }
    list.push_back({{"launch_elevation_deg", degrees(ray.launch_elevation)},
                    {"final_elevation_deg", degrees(ray.final_elevation)},
                    {"travel_time", ray.points.back().time},
                    {"path_length", ray.path_length},
                    {"surface_bounces", ray.surface_bounces},
                    {"bottom_bounces", ray.bottom_bounces},
                    {"turns", ray.turns},
                    {"surface_hits", ray.surface_hits},
                    {"range", range},
                    {"depth", z},
                    {"time", time}});
  }
  const nlohmann::ordered_json result = {{"filetype", "asdic rays"}, {"version", "1.0"},
                                         {"title", scenario.title},  {"scenario", scenario.path},
                                         {"source_depth", depth},    {"rays", list}};
  return result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

template <class T>
void column(Hdf5File& file, const std::string& dataset, const std::vector<T>& values,
            const std::string& long_name, const std::string& units = "") {
  file.write<T>(dataset, values, {values.size()});
  describe(file, dataset, long_name, units);
}

void write_file(const std::string& path, const Scenario& scenario, double depth,
                const std::vector<RayPath>& rays) {
  check_output(path, scenario.path);
  Hdf5Output output(path);
  Hdf5File& file = output.file();
  const Provenance made = provenance(1);
  file.set_attribute("", "filetype", "asdic rays");
  file.set_attribute("", "version", "1.0");
  file.set_attribute("", "title", scenario.title);
  file.set_attribute("", "program_version", made.program_version);
  file.set_attribute("", "build", made.build);
  file.set_attribute("", "scenario_sha256", sha256(scenario.text));
  file.set_attribute("", "source_depth_m", depth);
  if (!scenario.overrides.empty()) file.set_attribute("", "overrides", scenario.overrides);
  file.write_text("scenario", scenario.text);
  describe(file, "scenario", "the scenario file, verbatim");

  std::size_t points = 0, most_hits = 1;
  for (const RayPath& ray : rays) {
    points = std::max(points, ray.points.size());
    most_hits = std::max(most_hits, ray.surface_hits.size());
  }
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> range(rays.size() * points, missing), z = range, time = range;
  std::vector<double> hit(rays.size() * most_hits, missing);
  std::vector<double> launch, final, travel, length;
  std::vector<std::int32_t> index, surface, bottom, turns;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayPath& ray = rays[i];
    for (std::size_t j = 0; j < ray.points.size(); ++j) {
      range[i * points + j] = ray.points[j].range;
      z[i * points + j] = ray.points[j].depth;
      time[i * points + j] = ray.points[j].time;
    }
    std::copy(ray.surface_hits.begin(), ray.surface_hits.end(),
              hit.begin() + static_cast<std::ptrdiff_t>(i * most_hits));
    index.push_back(static_cast<std::int32_t>(i));
    launch.push_back(degrees(ray.launch_elevation));
    final.push_back(degrees(ray.final_elevation));
    travel.push_back(ray.points.back().time);
    length.push_back(ray.path_length);
    surface.push_back(ray.surface_bounces);
    bottom.push_back(ray.bottom_bounces);
    turns.push_back(ray.turns);
  }
  const auto scale = [&](const std::string& name, std::size_t n) {
    std::vector<std::int32_t> numbers(n);
    for (std::size_t i = 0; i < n; ++i) numbers[i] = static_cast<std::int32_t>(i);
    column<std::int32_t>(file, "rays/" + name, numbers, "number, from 0");
    file.make_scale("rays/" + name, name);
  };
  scale("ray", rays.size());
  scale("point", points);
  scale("hit", most_hits);
  column(file, "rays/launch_elevation_deg", launch, "elevation at launch, positive up", "degree");
  column(file, "rays/final_elevation_deg", final, "elevation of travel at the end", "degree");
  column(file, "rays/travel_time", travel, "travel time", "s");
  column(file, "rays/path_length", length, "length along the ray", "m");
  column(file, "rays/surface_bounces", surface, "reflections at the surface");
  column(file, "rays/bottom_bounces", bottom, "reflections at the bottom");
  column(file, "rays/turns", turns, "turning points between the boundaries");
  for (const char* name : {"launch_elevation_deg", "final_elevation_deg", "travel_time",
                           "path_length", "surface_bounces", "bottom_bounces", "turns"})
    file.attach_scales(std::string("rays/") + name, {"rays/ray"});
  const auto matrix = [&](const std::string& name, const std::vector<double>& values, std::size_t n,
                          const std::string& dimension, const std::string& long_name,
                          const std::string& units) {
    file.write<double>("rays/" + name, values, {rays.size(), n});
    describe(file, "rays/" + name, long_name, units);
    file.attach_scales("rays/" + name, {"rays/ray", "rays/" + dimension});
  };
  matrix("range", range, points, "point", "horizontal distance from the source", "m");
  matrix("depth", z, points, "point", "depth, positive down", "m");
  matrix("time", time, points, "point", "travel time", "s");
  matrix("surface_hit", hit, most_hits, "hit", "ranges where the ray meets the surface", "m");
  output.finish();
}

int rays(const Options& options) {
  const Scenario scenario = read_scenario(options.scenario.path, options.scenario.overrides);
  const Environment& ocean = scenario.environment;
  const double depth = options.depth.value_or(scenario.platform.at(0.0).position.z());
  if (!(depth >= ocean.surface.depth && depth <= ocean.bottom.depth))
    throw InputError({.where = "--source-depth",
                      .got = fmt::format("{} m", depth),
                      .expected = fmt::format("a depth between {} and {} m", ocean.surface.depth,
                                              ocean.bottom.depth)});
  std::vector<RayPath> paths;
  for (const double elevation : elevations(options))
    paths.push_back(
        trace_ray(ocean, depth, radians(elevation), options.range, 50.0, options.bounces));
  if (!options.output.empty()) write_file(options.output, scenario, depth, paths);
  if (options.json)
    print(as_json(scenario, depth, paths));
  else if (options.output.empty())
    print(as_table(paths));
  return 0;
}

}  // namespace

void add_rays_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "rays", "Trace a fan of rays from the platform and tell where they go.");
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
      "depth of the source; default: the platform's at the start");
  command->add_option("--bounces", options->bounces, "end a ray after so many bounces")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(0, 100000));
  command->add_flag("--json", options->json, "print JSON (docs/formats/rays.md)");
  command
      ->add_option("-o,--output", options->output,
                   "write HDF5 (docs/formats/rays.md), instead of the table")
      ->type_name("FILE.h5");
  command->footer(
      "Example:  asdic rays scenarios/deep_ocean.toml --from 0 --to 10 --count 11 --range 60km");
  command->callback([options, &action] { action = [options] { return rays(*options); }; });
}

}  // namespace asdic::app
