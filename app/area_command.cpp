#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/area_info.h"
#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/result/coverage_file.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "processing/coverage/coverage_of_scenario.h"

namespace asdic::detail::app {
namespace {

struct AreaOptions {
  ScenarioChoice scenario;
  std::string output;
  AreaWishes wishes;
  std::optional<double> reach;
  std::string fluctuation;
  std::optional<int> threads;
  bool json = false, force = false, quiet = false;
};

int area(AreaOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const ScenarioChoice& choice = options.scenario;
  Scenario scenario = read_scenario(choice.path, choice.overrides);
  const std::filesystem::path path =
      options.output.empty() ? std::filesystem::path(choice.path).stem().string() + "_area.h5"
                             : options.output;
  check_kind(path, "");
  options.wishes.reach = options.reach;
  if (!options.fluctuation.empty()) options.wishes.fluctuation = options.fluctuation;
  const CoverageSettings settings = coverage_settings(scenario, options.wishes);
  OutputFile output(path, rules_for(path, options.force, choice.path));
  if (!options.quiet) warn(scenario.notes);

  const int threads = options.threads.value_or(tbb::info::default_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  std::optional<PingSimulator> simulator;
  Coverage found;
  try {
    ProgressBar bar("%", 100, !options.quiet);
    until_interrupted([&] {
      MemoryBudget budget = read_budget(choice.path, choice.overrides);
      simulator.emplace(std::move(scenario), nullptr, budget);
      budget.take(coverage_need(*simulator, settings));
      found = coverage(*simulator, settings, [&](double share) {
        bar.done(100.0 * share);
        return true;
      });
    });
  } catch (const Interrupted&) {
    throw RunError("interrupted; no file was written");
  }
  if (!options.quiet) warn(found.warnings);
  write_area(std::move(output), found, simulator->scenario());
  ResultOrigin origin = origin_of(simulator->scenario());
  origin.path = choice.path;
  origin.warnings.insert(origin.warnings.end(), found.warnings.begin(), found.warnings.end());
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  const CoverageSummary summary = summary_of(found, origin.title);
  if (options.json)
    print(area_json(summary, origin, path));
  else if (!options.quiet)
    print(area_text(summary) +
          fmt::format("followed   {} off the surface, {} off the bottom, in {}\n",
                      count_of(std::size_t(found.followed.surface), "bounce"),
                      found.followed.bottom, count_of(std::size_t(found.planes), "plane")) +
          fmt::format("{}: {}, {}\n", path.string(),
                      byte_count(double(std::filesystem::file_size(path))),
                      duration(wall.count())));
  return 0;
}

}  // namespace

void add_area_command(Program& program) {
  program.add_command(
      "area",
      "What a sonar sees of the area around it: echo, reverberation, noise, signal excess and "
      "probability of detection over bearing and range.",
      [](const Command& command) {
        auto options = std::make_shared<AreaOptions>();
        AreaWishes& wishes = options->wishes;
        add_scenario_options(command, options->scenario);
        command
            .add_option("-o,--output", options->output,
                        "file to write; default: the scenario's name with _area.h5, in this folder")
            .type_name("FILE.h5");
        command
            .add_option("--depth", wishes.depths,
                        "of the target, or several: 50,150 [m]; default: the first target's")
            .type_name("M,...")
            .delimiter(',');
        command.add_length("--reach", options->reach,
                           "up to this range: 40km, 500m or plain metres; default: as far as the "
                           "record hears");
        command.add_option("--ranges", wishes.ranges, "cells from the array to there")
            .type_name("N")
            .show_default();
        command.add_option("--bearings", wishes.bearings, "cells all round")
            .type_name("N")
            .show_default();
        command
            .add_option("--strength", wishes.strength_db,
                        "of the target at every aspect [dB]; default: the first target's, without "
                        "one 10")
            .type_name("DB");
        command
            .add_option("--fluctuation", options->fluctuation,
                        "of the target: none or swerling-1 to swerling-4; default: the first "
                        "target's")
            .type_name("WORD");
        command
            .add_option("--false-alarm", wishes.false_alarm_probability,
                        "probability of one in a cell without an echo")
            .type_name("P")
            .show_default();
        command
            .add_option("--cells", wishes.reference_cells,
                        "over which the background is averaged; 0: it is known")
            .type_name("N")
            .show_default();
        command
            .add_option("--transmitter", wishes.transmitter, "that sends; default: that of --ping")
            .type_name("NAME");
        command.add_option("--array", wishes.array, "that listens; default: the first")
            .type_name("NAME");
        command
            .add_option("--ping", wishes.ping,
                        "of the run: where everything is then; default: the first")
            .type_name("N")
            .check(above_zero());
        add_threads_option(command, options->threads);
        add_force_option(command, options->force);
        command.add_flag("--json", options->json, "print a summary as JSON (docs/formats/area.md)");
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        command.footer(
            "Example:  asdic area scenarios/deep_ocean.toml --depth 150 --reach 20km -o area.h5 && "
            "asdic plot area.h5");
        command.runs([options] { return area(*options); });
      });
}

}  // namespace asdic::detail::app
