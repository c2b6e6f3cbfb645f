#include <fmt/format.h>

#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/output.h"
#include "core/error.h"
#include "io/bellhop/case_writer.h"
#include "io/bellhop/map_scenario.h"
#include "io/hdf5/own_files.h"
#include "io/result/write_result.h"
#include "io/scenario/propagation.h"
#include "io/scenario/writer.h"

namespace asdic::detail::app {
namespace {

struct ConvertOptions {
  std::string input, output;
  std::vector<std::string> overrides;
  std::optional<bool> wide, binary;  // none: as the input has it
  bool force = false, quiet = false;
};

std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

[[noreturn]] void refuse(const ConvertOptions& options, const std::string& expected) {
  throw InputError({.where = "convert",
                    .got = fmt::format("\"{}\" to \"{}\"", options.input, options.output),
                    .expected = expected});
}

std::vector<std::string> env_to_toml(const ConvertOptions& options) {
  const bellhop::Input input = bellhop::read_case(std::filesystem::path(options.input));
  const std::filesystem::path maps = std::filesystem::path(options.output).replace_extension(".nc");
  const bellhop::MapScenario made = bellhop::map_scenario(input, maps.string());
  OutputFile scenario(options.output, rules_for(options.output, options.force));
  if (made.maps)
    bellhop::write_maps(
        OutputFile(maps, {.own = own::hdf5, .worth = own::pings, .force = options.force}), input);
  scenario.write(std::string("# ") + own::remark + " convert.\n" + to_toml(made.run_case));
  std::vector<std::string> notes = input.notes;
  notes.insert(notes.end(), made.notes.begin(), made.notes.end());
  if (made.maps) notes.push_back("the maps of the scenario are in " + maps.string());
  return notes;
}

std::vector<std::string> toml_to_env(const ConvertOptions& options) {
  std::vector<std::string> notes;
  const PropagationCase run_case = read_propagation_case(options.input, options.overrides, notes);
  const bellhop::Written written = bellhop::write_case(run_case, options.binary.value_or(false));
  std::filesystem::path root = options.output;
  root.replace_extension();
  bellhop::write_case_files(root, written.texts, {.force = options.force});
  notes.insert(notes.end(), written.notes.begin(), written.notes.end());
  return notes;
}

/// A field, arrivals or rays from one kind of file to another.
std::vector<std::string> convert_result(const ConvertOptions& options) {
  PropagationFile result = read_result(options.input);
  try {
    write_result(OutputFile(options.output, rules_for(options.output, options.force)),
                 std::move(result), {.wide = options.wide, .binary = options.binary});
  } catch (const InputError& error) {
    if (error.fault().where != "output") throw;
    refuse(options, error.fault().expected);
  }
  return {};
}

int convert(const ConvertOptions& options) {
  const std::string from = extension_of(options.input), to = extension_of(options.output);
  check_output(options.output, rules_for(options.output, options.force, options.input));
  std::vector<std::string> notes;
  if (from == ".env" && to == ".toml") {
    notes = env_to_toml(options);
  } else if (from == ".toml" && to == ".env") {
    notes = toml_to_env(options);
  } else if (from == ".env" || from == ".toml" || to == ".env" || to == ".toml") {
    refuse(options, "a case (.env) to a scenario (.toml) or back");
  } else {
    notes = convert_result(options);
  }
  if (!options.quiet) {
    for (const std::string& note : notes) print("note: " + note + '\n');
    print(fmt::format("{}: {}\n", options.output,
                      byte_count(static_cast<double>(std::filesystem::file_size(options.output)))));
  }
  return 0;
}

}  // namespace

void add_convert_command(Program& program) {
  program.add_command(
      "convert",
      "Convert BELLHOP's files: a case (.env and companions) to a scenario (.toml) and back, a\n"
      "field, arrivals or rays (.shd, .arr, .ray) to HDF5 (.h5) and back.",
      [](const Command& command) {
        auto options = std::make_shared<ConvertOptions>();
        command.add_option("input", options->input, "what to read; its ending tells what it is")
            .type_name("INPUT")
            .required();
        command
            .add_option("output", options->output,
                        "what to write; its ending tells what it becomes")
            .type_name("OUTPUT")
            .required();
        command
            .add_option("--set", options->overrides,
                        "of a scenario: replace a value, e.g. --set run.frequency=500")
            .type_name("KEY=VALUE")
            .one_at_a_time();
        const auto either = [&](std::optional<bool>& choice, const char* yes, const char* what_yes,
                                const char* no, const char* what_no) {
          const Option one = command.add_flag(yes, choice, true, what_yes);
          command.add_flag(no, choice, false, what_no).excludes(one);
        };
        either(options->wide, "--wide",
               "numbers of 8 bytes in the head of .shd and .arr (the C++ port of BELLHOP)",
               "--fortran", "numbers of 4 bytes there; by default as the input had it");
        either(options->binary, "--binary", "arrivals as a binary .arr (run type a)", "--ascii",
               "arrivals as text; by default as the input had them");
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        add_force_option(command, options->force);
        command.footer(
            "A case of BELLHOP3D becomes the scenario of its first azimuth; its maps go beside it, "
            "in\n"
            "NAME.nc.\n"
            "Example:  asdic convert munk.env munk.toml");
        command.runs([options] { return convert(*options); });
      });
}

}  // namespace asdic::detail::app
