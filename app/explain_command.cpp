#include <tbb/global_control.h>
#include <tbb/info.h>

#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/explanation.h"
#include "app/interrupt.h"
#include "app/progress_bar.h"
#include "core/error.h"

namespace asdic::detail::app {
namespace {

struct ExplainChoice {
  std::string root;
  ExplainOptions finer;
  std::optional<int> threads;
  bool json = false, quiet = false;
};

int explain_case(const ExplainChoice& options) {
  const bellhop::Input input = bellhop::read_case(std::filesystem::path(options.root));
  bellhop::require_one_plane(input);
  const tbb::global_control limit(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(options.threads.value_or(tbb::info::default_concurrency())));
  std::optional<ProgressBar> bar(std::in_place, "%", 100, !options.quiet);
  const auto progress = [&](double share) {
    bar->done(100.0 * share);
    return true;
  };
  try {
    Explanation explanation;
    until_interrupted([&] { explanation = explain(input, options.root, options.finer, progress); });
    bar.reset();
    print(options.json ? explanation_json(explanation) : explanation_table(explanation));
  } catch (const Interrupted&) {
    throw RunError("interrupted");
  }
  return 0;
}

}  // namespace

void add_explain_command(Program& program) {
  program.add_command(
      "explain", "A BELLHOP case as BELLHOP does it and as it should be, and why they differ.",
      [](const Command& command) {
        auto options = std::make_shared<ExplainChoice>();
        command.add_option("ROOT", options->root, "the case: ROOT.env and its companions")
            .required()
            .type_name("ROOT");
        command
            .add_option("--finer-step", options->finer.finer_step,
                        "by how much the step is divided to tell what it costs")
            .show_default()
            .type_name("N")
            .check(between(1.0, 1e4));
        command
            .add_option("--denser-fan", options->finer.denser_fan,
                        "by how much the number of beams is multiplied to tell what it costs")
            .show_default()
            .type_name("N")
            .check(between(1.0, 1e3));
        add_threads_option(command, options->threads);
        command.add_flag("--json", options->json, "print JSON (docs/theory/bellhop-emulation.md)");
        command.add_flag("-q,--quiet", options->quiet, "no progress on standard error");
        command.footer(
            "The table splits the difference into what BELLHOP's step, number of beams, merging "
            "of arrivals and single precision each change alone. A ROOT.shd, .arr or .ray beside "
            "the case is compared as well.\n"
            "Example:  asdic explain cases/munk");
        command.runs([options] { return explain_case(*options); });
      });
}

}  // namespace asdic::detail::app
