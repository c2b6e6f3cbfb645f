#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/field_output.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/bellhop/bellhop_files.h"
#include "io/scenario/propagation.h"
#include "io/text/csv_table.h"
#include "raytrace/propagation.h"

namespace asdic::detail::app {
namespace {

struct FieldOptions {
  ScenarioChoice scenario;
  std::string output;
  std::optional<int> threads;
  bool bellhop_emulation = false, json = false, force = false, quiet = false;
};

bool is_shade_name(const std::filesystem::path& path) { return path.extension() == ".shd"; }

PropagationResult run_field_of(const PropagationCase& run_case, const FieldOptions& options) {
  ProgressBar bar("%", 100, !options.quiet);
  const Progress progress = [&](double share) {
    bar.done(100.0 * share);
    return true;
  };
  try {
    const MemoryBudget budget = read_budget(options.scenario.path, options.scenario.overrides);
    PropagationResult result;
    until_interrupted([&] {
      result = options.bellhop_emulation ? run_bellhop_emulation(run_case, progress, budget)
                                         : run(run_case, progress, budget);
    });
    return result;
  } catch (const Interrupted&) {
    throw RunError("interrupted; no file was written");
  } catch (const InputError& error) {
    throw told_of_scenario(error, options.scenario.path, options.scenario.overrides);
  }
}

int field(const FieldOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  FieldResult result;
  std::vector<std::string> warnings;
  result.run_case =
      read_propagation_case(options.scenario.path, options.scenario.overrides, warnings);
  if (asks_for_rays(options.scenario.path, options.scenario.overrides))
    throw InputError({.where = options.scenario.path + ": run.task",
                      .got = '"' + std::string(word_of(result.run_case.task)) + '"',
                      .expected = "\"field\"; asdic rays does what this asks for, and --set "
                                  "run.task=field makes a field of it"});
  result.run_case.task = Task::field;
  result.origin = {.title = result.run_case.title,
                   .path = options.scenario.path,
                   .text = read_text_file(options.scenario.path, "a scenario file"),
                   .overrides = options.scenario.overrides,
                   .warnings = warnings,
                   .origin = result.run_case.origin};
  result.output = options.output.empty()
                      ? std::filesystem::path(options.scenario.path).stem().string() + ".h5"
                      : options.output;
  check_kind(result.output, ".shd");
  OutputFile output(result.output, rules_for(result.output, options.force, options.scenario.path));
  if (!options.quiet) warn(warnings);

  const int threads = options.threads.value_or(tbb::info::default_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  PropagationResult found = run_field_of(result.run_case, options);
  result.notes.insert(result.notes.end(), found.notes.begin(), found.notes.end());
  result.data = field_data(result.run_case, std::move(found));
  if (is_shade_name(result.output))
    bellhop::write_shade_file(std::move(output), to_shade_file(result.data));
  else
    write_field_file(std::move(output), result);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  if (options.json)
    print(field_json(result));
  else if (!options.quiet)
    print(field_text(result, wall.count()));
  return 0;
}

}  // namespace

void add_field_command(Program& program) {
  program.add_command(
      "field", "The pressure field of a source over range and depth: transmission loss.",
      [](const Command& command) {
        auto options = std::make_shared<FieldOptions>();
        add_scenario_options(command, options->scenario);
        command
            .add_option(
                "-o,--output", options->output,
                "file to write, HDF5 (docs/formats/field.md) or by its ending .shd; default: the "
                "scenario's name with .h5, in this folder")
            .type_name("FILE");
        add_threads_option(command, options->threads);
        add_force_option(command, options->force);
        command.add_flag("--like-bellhop", options->bellhop_emulation,
                         "as BELLHOP does it, with its steps and beams; for comparison");
        command.add_flag("--json", options->json,
                         "print a summary as JSON (docs/formats/field.md)");
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        command.footer(
            "What is run stands in [run] of the scenario (docs/formats/scenario.md).\n"
            "Example:  asdic field scenarios/wedge.toml -o wedge.h5 && asdic plot wedge.h5");
        command.runs([options] { return field(*options); });
      });
}

}  // namespace asdic::detail::app
