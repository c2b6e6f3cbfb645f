#include <fmt/format.h>

#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/output.h"
#include "core/error.h"
#include "io/climatology/climatology.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::app {
namespace {

struct OceanOptions {
  double latitude = 0.0, longitude = 0.0;  // [°]
  std::optional<int> month;
  std::optional<double> bearing, range;  // [°], [m]
  std::string data, output;
  bool force = false;
};

int ocean(const OceanOptions& options) {
  if (options.bearing.has_value() != options.range.has_value())
    throw InputError({.where = options.bearing ? "--range" : "--bearing",
                      .got = "nothing",
                      .expected = "a value: --bearing and --range go together"});
  std::optional<OutputFile> output;
  if (!options.output.empty())
    output.emplace(options.output, OutputRules{.own = own::scenario, .force = options.force});
  const OceanSources sources =
      options.data.empty() ? default_ocean_sources() : default_ocean_sources(options.data);
  const OceanSample sample =
      sample_ocean(sources, options.latitude, options.longitude, options.month);
  std::optional<OceanSection> section;
  if (options.bearing)
    section = sample_section(sources, options.latitude, options.longitude, *options.bearing,
                             *options.range, options.month);
  const std::string fragment = write_scenario_fragment(sample, section);
  if (!output) {
    print(fragment);
    return 0;
  }
  output->write(fragment);
  print(fmt::format("{}: {} to {:g} m, water {:g} m deep\n", options.output,
                    count_of(sample.depth.size(), "level"), sample.depth.back(),
                    sample.water_depth));
  for (const std::string& note : sample.notes) print(fmt::format("note: {}\n", note));
  if (section)
    for (const std::string& note : section->notes) print(fmt::format("note: {}\n", note));
  return 0;
}

}  // namespace

void add_ocean_command(Program& program) {
  program.add_command(
      "ocean", "Write the [environment] of a real place, out of measured climatologies.",
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
        command.add_option("--month", options->month, "1 to 12; default: the mean of the year")
            .type_name("N")
            .check(between(1, 12));
        command
            .add_option("--bearing", options->bearing,
                        "true bearing of a track: sea floor and water along it instead of one "
                        "place's [deg]")
            .type_name("DEG")
            .check(between(-360.0, 360.0));
        command.add_length("--range", options->range, "length of that track, e.g. 60km");
        command
            .add_option("--data", options->data,
                        "folder of the climatologies; default: where Debian's ferret-datasets is")
            .type_name("DIR");
        command
            .add_option("-o,--output", options->output, "file to write; default: standard output")
            .type_name("FILE.toml");
        add_force_option(command, options->force);
        command.footer(
            "A scenario takes it with include = \"FILE.toml\".\n"
            "Example:  asdic ocean --latitude 30.5 --longitude -60.5 --month 3 -o ocean.toml");
        command.runs([options] { return ocean(*options); });
      });
}

}  // namespace asdic::detail::app
