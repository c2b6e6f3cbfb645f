#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/output.h"
#include "core/error.h"
#include "core/text.h"
#include "io/climatology/climatology.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::app {
namespace {

struct OceanOptions {
  double latitude = 0.0, longitude = 0.0;  // [°]
  std::optional<int> month;
  std::string date;
  std::optional<double> bearing, range, step, area;  // [°], [m]
  std::vector<std::string> temperature, salinity, sound_speed, bathymetry, wind, sediment;
  std::string data, output;
  bool force = false;
};

OceanRequest request_of(const OceanOptions& options) {
  OceanRequest request{.latitude = options.latitude,
                       .longitude = options.longitude,
                       .when = {.month = options.month},
                       .bearing_deg = options.bearing.value_or(0.0),
                       .range = options.range.value_or(0.0),
                       .step = options.step};
  if (options.date.empty()) return request;
  if (options.month)
    throw InputError({.where = "--month", .got = "--date beside it", .expected = "one of them"});
  request.when.date = parse_moment(options.date);
  if (!request.when.date)
    throw InputError({.where = "--date",
                      .got = in_quotes(options.date),
                      .expected = "a date by ISO 8601: 2024-02-29 or 2024-02-29T06:00"});
  return request;
}

OceanSources sources_of(const OceanOptions& options) {
  OceanSources named{.temperature = data_files(options.temperature),
                     .salinity = data_files(options.salinity),
                     .sound_speed = data_files(options.sound_speed),
                     .bathymetry = data_files(options.bathymetry),
                     .wind = data_files(options.wind),
                     .sediment = data_files(options.sediment)};
  return or_default(std::move(named), options.data.empty() ? default_ocean_sources()
                                                           : default_ocean_sources(options.data));
}

void check(const OceanOptions& options) {
  const auto fault = [](const char* where, const char* got, const char* expected) {
    return InputError({.where = where, .got = got, .expected = expected});
  };
  if (options.bearing.has_value() != options.range.has_value())
    throw fault(options.bearing ? "--range" : "--bearing", "nothing",
                "a value: --bearing and --range go together");
  if (options.step && !options.range)
    throw fault("--step", "a place", "a track: --bearing and --range");
  if (options.area && options.range)
    throw fault("--area", "a track", "an area, or --bearing and --range");
  if (options.area && options.output.empty())
    throw fault("--area", "no --output", "-o NAME.toml: its maps go beside it, in NAME.nc");
}

int ocean(const OceanOptions& options) {
  check(options);
  const OceanSources sources = sources_of(options);
  std::optional<OutputFile> output, maps;
  if (!options.output.empty())
    output.emplace(
        options.output,
        OutputRules{.own = own::scenario, .force = options.force, .inputs = sources.paths()});
  if (options.area) {
    const std::filesystem::path name =
        std::filesystem::path(options.output).replace_extension(".nc");
    maps.emplace(name, OutputRules{.own = own::hdf5,
                                   .worth = own::pings,
                                   .force = options.force,
                                   .inputs = sources.paths()});
  }
  const OceanRequest request = request_of(options);
  OceanSample sample = sample_ocean(sources, request);
  std::optional<OceanSection> section;
  if (options.range) section = sample_section(sources, request);
  std::optional<OceanArea> area;
  if (options.area)
    area = write_ocean_area(sources, request, sample, *options.area, std::move(*maps));
  const std::string fragment =
      area ? write_area_fragment(sample, *area) : write_scenario_fragment(sample, section);
  if (!output) {
    print(fragment);
    return 0;
  }
  output->write(fragment);
  const auto tenths = [](double depth) { return to_text(std::round(10.0 * depth) / 10.0); };
  print(fmt::format("{}: {} to {} m, water {} m deep\n", options.output,
                    count_of(sample.depth.size(), "level"), tenths(sample.depth.back()),
                    tenths(sample.water_depth)));
  if (area) print(fmt::format("{}: {:g} km square\n", area->file.string(), area->side / 1000.0));
  for (const std::string& origin : sample.origins) print(fmt::format("data: {}\n", origin));
  for (const std::string& note : sample.notes) print(fmt::format("note: {}\n", note));
  if (section)
    for (const std::string& note : section->notes) print(fmt::format("note: {}\n", note));
  if (area)
    for (const std::string& note : area->notes) print(fmt::format("note: {}\n", note));
  return 0;
}

void add_files(const Command& command, const char* name, std::vector<std::string>& files,
               const char* help) {
  command.add_option(name, files, help).type_name("FILE").one_at_a_time().group("Data");
}

}  // namespace

void add_ocean_command(Program& program) {
  program.add_command(
      "ocean", "Write the [environment] of a real place, out of measured data.",
      [](const Command& command) {
        auto options = std::make_shared<OceanOptions>();
        command.add_option("--latitude", options->latitude, "degrees north")
            .required()
            .type_name("DEG")
            .check(between(-90.0, 90.0));
        command
            .add_option("--longitude", options->longitude, "degrees east, -180 to 180 or 0 to 360")
            .required()
            .type_name("DEG")
            .check(between(-180.0, 360.0));
        command
            .add_option("--date", options->date,
                        "of the data, interpolated between their times: 2024-02-29, or with T06:00")
            .type_name("DATE");
        command
            .add_option("--month", options->month,
                        "1 to 12: mean of the data's times in it; default: the mean of all")
            .type_name("N")
            .check(between(1, 12));
        command
            .add_option("--bearing", options->bearing,
                        "true bearing of a track: sea floor and water along it instead of one "
                        "place's [deg]")
            .type_name("DEG")
            .check(between(-360.0, 360.0));
        command.add_length("--range", options->range, "length of that track, e.g. 60km");
        command.add_length("--step", options->step,
                           "between depths along it; default: the grid's own spacing");
        command.add_length("--area", options->area,
                           "side of a square about the place, e.g. 200km: maps in NAME.nc beside "
                           "-o NAME.toml");
        add_files(command, "--temperature", options->temperature,
                  "grids on depth (World Ocean Atlas, HYCOM, CMEMS, ...), Argo profiles, or CTD "
                  "casts (.csv, .cnv)");
        add_files(command, "--salinity", options->salinity,
                  "default: in the files of the temperature");
        add_files(command, "--sound-speed", options->sound_speed, "in place of both");
        add_files(command, "--bathymetry", options->bathymetry,
                  "heights or depths (GEBCO, ...); more than one: tiles");
        add_files(command, "--wind", options->wind, "speeds, or components (ERA5, ...)");
        add_files(command, "--sediment", options->sediment,
                  "grain sizes or classes; default: by the depth of the water");
        command
            .add_option("--data", options->data,
                        "folder of what is not named; default: where Debian's ferret-datasets is")
            .type_name("DIR")
            .group("Data");
        command
            .add_option("-o,--output", options->output, "file to write; default: standard output")
            .type_name("FILE.toml");
        add_force_option(command, options->force);
        command.footer(
            "A scenario takes it with include = \"FILE.toml\". Options of files may be repeated, "
            "and name a variable, or the band of a raster: FILE:VARIABLE, FILE:BAND.\n"
            "Example:  asdic ocean --latitude 30.5 --longitude -60.5 --month 3 -o ocean.toml");
        command.runs([options] { return ocean(*options); });
      });
}

}  // namespace asdic::detail::app
