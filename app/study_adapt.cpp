#include "app/study_adapt.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <cmath>
#include <fstream>

#include "app/console.h"
#include "app/interrupt.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/files/output_file.h"
#include "study/reader/study_reader.h"
#include "study/runs/adapt.h"

namespace asdic::detail::app {
namespace {

/// The files that a study names are relative to it.
void check_folder(const std::filesystem::path& study, const std::filesystem::path& made) {
  const auto folder = [](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path).parent_path());
  };
  if (folder(study) != folder(made))
    throw InputError({.where = "--adapt",
                      .got = made.string() + ", in another folder than " + study.string(),
                      .expected = "a file beside the study: what it names is relative to it"});
}

void check_alone(const StudyOptions& options) {
  if (options.until.empty() && !options.fresh && !options.assemble && !options.retry &&
      !options.compare && !options.join && !options.report && options.range.empty() &&
      options.shard.empty() && options.output.empty())
    return;
  throw InputError({.where = "--adapt",
                    .got = "another option beside it that is of a run",
                    .expected = "--set, --threads, --force and --quiet alone: it makes no file of "
                                "results"});
}

std::string level_text(const study::AdaptedLevel& told) {
  const study::Level& level = told.level;
  const std::string reached =
      level.there() ? "reach the event" : fmt::format("reach to {:.3g} below it", -level.reached);
  return fmt::format(
      "level {}: the best {} of {} rows {}{}\n", told.number, level.rows, told.made, reached,
      told.known < told.made ? fmt::format("; of {} it is not known", told.made - told.known) : "");
}

}  // namespace

int adapt_study(const StudyOptions& options) {
  check_alone(options);
  const std::filesystem::path path = options.paths.at(0), made = options.adapt;
  check_folder(path, made);
  const study::Study study = study::read_study(path, options.overrides);
  for (const std::string& assignment : study.overrides)
    if (assignment.starts_with("rare."))
      throw InputError({.where = "--set " + assignment,
                        .got = "a key of [rare] beside --adapt",
                        .expected = "it in the study file, which the new one continues"});
  OutputFile output(made, {.force = options.force, .inputs = {path}, .option = "--adapt"});
  const tbb::global_control limit(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(options.threads.value_or(tbb::info::default_concurrency())));
  const StopOnInterrupt interrupt("asdic: stopping: nothing is written");
  double guess = 0.0;
  int levels = 0;
  std::uint64_t rows = 0;
  const auto parts = study::adapt(
      study,
      [&](const study::AdaptedLevel& told) {
        if (!options.quiet) print(level_text(told));
        flush_output();
        guess = told.level.probability;
        levels = told.number;
        rows += told.made;
      },
      interrupt.token());
  const std::string note = fmt::format(
      "# From where rows are drawn so that they reach the event: found by asdic study --adapt in "
      "{} "
      "of\n# {} rows, seed {}. Centres and deviations of the inputs' normal scores. Nothing is "
      "biased by them.\n",
      count_of(static_cast<std::size_t>(levels), "level"), study.rare.rows_per_level, study.seed);
  std::ofstream(output.part(), std::ios::binary) << with_components(study, parts, note);
  const study::Study read = study::read_study(output.part(), options.overrides);
  if (read.proposal.parts().size() < parts.size() + 1)
    throw RunError(output.part().string() + ": what was written cannot be read again");
  output.finish();
  if (options.quiet) return 0;
  print(
      fmt::format("{} in all; {} of what is drawn, P about {:.1g} (a guide: these rows serve "
                  "nothing else)\n",
                  count_of(rows, "row"), count_of(parts.size(), "component"), guess));
  std::string sets;
  for (const std::string& one : options.overrides) sets += " --set '" + one + "'";
  print(fmt::format("{}: asdic study {}{} makes the study\n", made.string(), made.string(), sets));
  return 0;
}

}  // namespace asdic::detail::app
