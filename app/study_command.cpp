#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "app/console.h"
#include "app/interrupt.h"
#include "app/pictures.h"
#include "app/study_adapt.h"
#include "app/study_comparison.h"
#include "app/study_options.h"
#include "app/study_pilot.h"
#include "app/study_progress.h"
#include "app/warn.h"
#include "core/error.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/propagation.h"
#include "study/crew/crew_run.h"

namespace asdic::detail::app {
namespace {

void check_join(const StudyOptions& options) {
  if (options.silence && !options.join)
    throw InputError({.where = "--silence", .got = "no --join", .expected = "both or none"});
  if (options.join &&
      (!options.until.empty() || options.fresh || options.assemble || options.retry ||
       options.compare || !options.range.empty() || !options.shard.empty()))
    throw InputError({.where = "--join",
                      .got = "--until, --fresh, --retry, --assemble, --compare, --realisations or "
                             "--shard beside it",
                      .expected = "none of them: the same whole study in all processes"});
}

int study_run(const StudyOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  StudyOrder order = order_of(options);
  check_join(options);
  if (options.join && order.run.until)
    throw InputError({.where = order.study.until_where,
                      .got = "study.until beside --join",
                      .expected = "one of them; --set study.until=[] goes on to the end"});
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(order.threads));
  const StopOnInterrupt interrupt(
      "asdic: stopping: the rows that are made are kept, those in hand are left; Ctrl-C again ends "
      "at "
      "once");
  order.run.stop = interrupt.token();
  std::optional<StudyProgress> progress(std::in_place, !options.quiet);
  const study::Realiser realiser(order.study);
  study::Work work = [&] {
    std::optional<study::Work> made;  // what its levels lack takes a search
    try {
      until_stopped(interrupt.token(),
                    [&] { made.emplace(study::work_of(order.study, realiser)); });
    } catch (const Interrupted&) {
      throw RunError("interrupted before the first realisation was done");
    }
    return std::move(*made);
  }();
  if (!options.quiet && !options.brief) warn(work.fingerprint.warnings);
  if (const std::string design = study::design_text(order.study);
      !options.quiet && !options.brief && !design.empty())
    print(design + '\n');
  work.realise = study::watched(work, order.run.note);
  order.run.progress = [&](const study::Progress& p) { progress->update(p); };
  study::StudyOutcome outcome =
      options.join ? study::run_crew(work, order.run) : study::run_study(work, order.run);
  progress.reset();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  if (options.brief) outcome.found.clear();  // of all rows, not of one round's
  const int status = report(order, outcome, options.quiet || options.brief, wall.count());
  if (status != 0 || !options.report || options.compare) return status;
  flush_output();
  return draw_pictures({order.run.output.string(), "--html"});
}

}  // namespace

void add_study_command(Program& program) {
  program.add_command(
      "study", "Simulate the realisations of a Monte Carlo study, into one HDF5 file.",
      [](const Command& command) {
        auto options = std::make_shared<StudyOptions>();
        command.add_option("STUDY", options->paths, "study file (TOML); several with --compare")
            .required();
        command.add_flag("--compare", options->compare,
                         "make several studies of the same realisations and say which is better, "
                         "where and how sure; -o is the comparison's file");
        add_study_options(command, *options);
        const Option range =
            command
                .add_option(
                    "--realisations", options->range,
                    "only these indices, FIRST up to but not including END; asdic merge puts "
                    "parts together")
                .type_name("FIRST:END");
        command
            .add_option(
                "--shard", options->shard,
                "only the I-th of N parts, counted from 1; slurm: the part of this task of a "
                "Slurm job array")
            .type_name("I/N|slurm")
            .excludes(range);
        command.add_flag("--report", options->report,
                         "then write a page for a browser beside the file: question, answers with "
                         "their intervals, what was drawn, pictures, seeds and digests");
        command.add_flag("--join", options->join,
                         "make the study together with all processes that run the same command, on "
                         "machines that share its folder; they come and go, and one that is lost "
                         "costs the rows that it had in hand");
        command
            .add_option("--silence", options->silence,
                        "with --join: after so long without a sign of life a process is taken for "
                        "gone; default: 120 s")
            .type_name("SECONDS")
            .check(above_zero());
        command
            .add_option("--adapt", options->adapt,
                        "make no study: find, level by level, from where inputs reach the event of "
                        "[rare], and write the study with it, to be made by the same command")
            .type_name("FILE.toml");
        command
            .add_option("--pilot", options->pilot,
                        "make so many realisations (16 are a good number), write nothing, and say "
                        "what the whole will cost in time, memory and disk, where the time goes "
                        "and what to turn")
            .type_name("ROWS")
            .check(whole_number(1, 100000, "a number of realisations"));
        command.add_flag("--assemble", options->assemble,
                         "make no realisations: write a file of those that are there");
        command.footer(
            "Whatever stops it (Ctrl-C, a kill, a power cut), the same command goes on where it "
            "was.\n"
            "Example:  asdic study scenarios/studies/detection_range.toml -o detection_range.h5");
        command.runs([options] {
          if (!options->adapt.empty()) return adapt_study(*options);
          if (options->pilot) return try_study(*options);
          return options->compare ? compare_studies(*options, study_run) : study_run(*options);
        });
      });
}

}  // namespace asdic::detail::app
