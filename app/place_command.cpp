#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/place_info.h"
#include "app/progress_bar.h"
#include "app/warn.h"
#include "core/error.h"
#include "study/placement/placement_reader.h"

namespace asdic::detail::app {
namespace {

struct PlaceOptions {
  std::string path, output;
  std::vector<std::string> overrides;
  std::optional<int> threads;
  bool json = false, force = false, quiet = false;
};

int place(const PlaceOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const study::PlacementPlan plan = study::read_placement(options.path, options.overrides);
  const std::filesystem::path path =
      options.output.empty() ? std::filesystem::path(options.path).stem().string() + ".h5"
                             : options.output;
  check_kind(path, "");
  OutputRules rules = rules_for(path, options.force, options.path);
  for (const study::PlacementOption& option : plan.options) rules.inputs.push_back(option.path);
  OutputFile output(path, rules);
  const int threads = options.threads.value_or(tbb::info::default_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  study::Placement found;
  try {
    ProgressBar bar("%", 100, !options.quiet);
    until_interrupted([&] {
      found = study::place_sensors(plan, [&](double share) {
        bar.done(100.0 * share);
        return true;
      });
    });
  } catch (const Interrupted&) {
    throw RunError("interrupted; no file was written");
  }
  if (!options.quiet) warn(found.warnings);
  study::write_placement(std::move(output), plan, found);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  const study::PlacementAnswer answer = study::answer_of(plan, found);
  if (options.json)
    print(placement_json(answer, options.path, path));
  else if (!options.quiet)
    print(placement_text(answer) + fmt::format("{}: {}, {}\n", path.string(),
                                               byte_count(double(std::filesystem::file_size(path))),
                                               duration(wall.count())));
  return 0;
}

}  // namespace

void add_place_command(Program& program) {
  program.add_command(
      "place",
      "Say where sensors are best put and with which pulses, how good that is at best, and how "
      "sure.",
      [](const Command& command) {
        auto options = std::make_shared<PlaceOptions>();
        command
            .add_option("PLAN", options->path,
                        "plan (TOML): sensors, places, options, cells to protect, what is drawn")
            .required();
        command
            .add_option("-o,--output", options->output,
                        "file to write; default: the plan's name with .h5, in this folder")
            .type_name("FILE.h5");
        command
            .add_option("--set", options->overrides,
                        "override a key of the plan or of all its scenarios: placement.sensors=3")
            .type_name("KEY.PATH=VALUE")
            .one_at_a_time();
        add_threads_option(command, options->threads);
        add_force_option(command, options->force);
        command.add_flag("--json", options->json,
                         "print the answer as JSON (docs/formats/placement.md)");
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        command.footer(
            "Example:  asdic place scenarios/placement/strait.toml -o strait.h5 && asdic plot "
            "strait.h5");
        command.runs([options] { return place(*options); });
      });
}

}  // namespace asdic::detail::app
