#include "app/study_options.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "app/console.h"
#include "app/output.h"
#include "app/study_progress.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/ping/provenance.h"
#include "study/reader/study_reader.h"
#include "study/sampling/shard.h"

namespace asdic::detail::app {
namespace {

std::optional<std::string> environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

study::IndexRange range_of(const StudyOptions& options, std::uint64_t count) {
  if (!options.range.empty()) return study::parse_range(options.range, count);
  if (!options.shard.empty()) return study::parse_shard(options.shard, count, environment);
  return {0, count};
}

/// STUDY.h5, and for a part STUDY_FIRST-END.h5, in this folder.
std::filesystem::path default_output(const std::string& study, study::IndexRange range,
                                     std::uint64_t count) {
  const std::string stem = std::filesystem::path(study).stem().string();
  if (range == study::IndexRange{0, count}) return stem + ".h5";
  return fmt::format("{}_{}-{}.h5", stem, range.first, range.end);
}

/// Of the command, or else of the study file.
study::Until until_of(const StudyOptions& options, const StudyOrder& order) {
  const study::Study& study = order.study;
  const bool of_file = options.until.empty();
  if (of_file && (study.until.empty() || options.pays_no_heed)) return {};
  const std::string where = of_file ? study.until_where : "--until";
  study::check_until(study, where);
  if (order.run.range != study::IndexRange{0, study.realisations})
    throw InputError(
        {.where = where,
         .got = "a part of the study (" + study::index_text(order.run.range) + ")",
         .expected = "the whole of it: a part cannot know when all have enough" +
                     std::string(of_file ? "; --set study.until=[] makes parts" : "")});
  return {study, of_file ? study.until : options.until, where};
}

}  // namespace

std::string known_text(const study::Known& known) {
  std::string where = known.where;
  if (std::isfinite(known.rows))
    where += ", " + count_of(static_cast<std::size_t>(known.rows), "realisation");
  if (!where.empty()) where = " (" + where + ')';
  const std::string empty = known.empty == 0 ? ""
                                             : fmt::format("; {} of {} cells without a realisation",
                                                           known.empty, known.cells);
  if (known.rule.empty())
    return fmt::format("{}: {}{}, asked for ± {:g}", known.name,
                       std::isfinite(known.half_width) ? fmt::format("± {:.3g}", known.half_width)
                                                       : "not known",
                       where.empty() ? "" : " at the worst" + where, known.asked) +
           empty;
  const auto first = known.rule.find_first_not_of(' ');
  std::string text =
      fmt::format("{}: {}: {}{}", known.name, known.rule.substr(std::min(first, known.rule.size())),
                  known.holds ? "holds" : "does not hold", where);
  const study::RuleValues& values = known.values;
  if (std::isfinite(values.mean))
    text += fmt::format(", {:.4g} ({:.4g} to {:.4g} over all looks)", values.mean, values.low,
                        values.high);
  return text + empty;
}

void add_study_options(const Command& command, StudyOptions& options) {
  command
      .add_option("-o,--output", options.output,
                  "file to write; default: the study's name with .h5, in this folder")
      .type_name("FILE.h5");
  command
      .add_option("--set", options.overrides,
                  "override a key of the study or its scenario: study.realisations=1000")
      .type_name("KEY.PATH=VALUE")
      .one_at_a_time();
  command
      .add_option(
          "--until", options.until,
          "stop once the confidence interval is at most twice this wide: of the study's first "
          "question, or of NAME, a measure (pd), the worst bin of a table (pd_by_range), the worst "
          "cell of the map (map_pd) or an index (total_order); or once a rule holds, 'pd: low > "
          "0.9 || high < 0.9', of mean, low, "
          "high, half_width and rows; repeated, all of them; looked at after 100, 200, ... 1000, "
          "2000, ... realisations or blocks; of --compare: of the paired difference")
      .type_name("[NAME=]HALF_WIDTH|RULE")
      .one_at_a_time();
  command.add_flag("--fresh", options.fresh, "begin anew: what is there is written over");
  command.add_flag("--retry", options.retry,
                   "make rows again that were skipped, or passed over because processes died with "
                   "them");
  add_threads_option(command, options.threads);
  add_force_option(command, options.force);
  command.add_flag("-q,--quiet", options.quiet, "print nothing unless something is wrong");
}

StudyOrder order_of(const StudyOptions& options) {
  if (options.paths.size() != 1)
    throw InputError({.where = options.paths.at(1),
                      .got = "a second study",
                      .expected = "one; --compare makes several and compares them"});
  const std::string& path = options.paths.front();
  StudyOrder order{.study = study::read_study(path, options.overrides)};
  order.threads = options.threads.value_or(tbb::info::default_concurrency());
  const std::uint64_t count = order.study.realisations;
  order.run.range = range_of(options, count);
  order.run.output = options.output.empty() ? default_output(path, order.run.range, count)
                                            : std::filesystem::path(options.output);
  check_output(order.run.output, rules_for(order.run.output, options.force, path));
  order.run.until = until_of(options, order);
  order.run.fresh = options.fresh;
  order.run.force = options.force;
  order.run.retry = options.retry;
  if (options.silence) order.run.silence = std::chrono::duration<double>(*options.silence);
  order.run.note = [](const std::string& text) { tell("asdic: note: " + text); };
  order.run.assemble_only = options.assemble;
  order.run.session.made = provenance(order.threads);
  order.run.session.study_path = std::filesystem::absolute(path).string();
  return order;
}

namespace {

/// "study.h5.journal holds them"; of ranks of MPI, "study.h5.rank*.journal hold them".
std::string journals_hold(const std::filesystem::path& output) {
  const auto journals = study::journals_of(output);
  if (journals.size() == 1) return journals.front().string() + " holds them";
  const bool ranks_alone =
      std::find(journals.begin(), journals.end(), study::journal_of(output)) == journals.end();
  return output.string() + (ranks_alone ? ".rank*.journal" : "*.journal") + " hold them";
}

/// "4 threads"; "4 ranks of 1 thread"
std::string workers(const StudyOrder& order) {
  const std::string threads = count_of(static_cast<std::size_t>(order.threads), "thread");
  return order.ranks == 1 ? threads : fmt::format("{} ranks of {}", order.ranks, threads);
}

/// What became of --until: whether all is known as well as it asks for, and how well.
std::string until_text(const study::StudyOutcome& outcome) {
  const std::string all = count_of(outcome.range.size(), "realisation");
  const bool enough = std::all_of(outcome.known.begin(), outcome.known.end(),
                                  [](const study::Known& known) { return known.enough(); });
  std::string text = outcome.stopped_early ? "enough after " + all
                     : enough              ? "as well known as is asked for, after all " + all
                                           : "not as well known as is asked for";
  for (const study::Known& known : outcome.known)
    if (outcome.known.size() > 1 || !known.where.empty() || !known.enough() || !known.rule.empty())
      text += "\n  " + known_text(known);
  return text;
}

}  // namespace

int report(const StudyOrder& order, const study::StudyOutcome& outcome, bool quiet,
           double seconds) {
  const std::string file = order.run.output.string();
  const std::uint64_t there = outcome.before + outcome.made;
  if (outcome.damaged > 0)
    print(fmt::format("{} in the journal did not match their checksum and were made again\n",
                      count_of(outcome.damaged, "realisation")));
  if (!outcome.warning.empty()) warn({outcome.warning});
  warn(outcome.found);
  if (!outcome.written)
    throw RunError(
        there == 0
            ? "interrupted before the first realisation was done; the same command begins anew"
            : fmt::format("interrupted after {} of {}; {}, and the same command goes on", there,
                          count_of(outcome.total, "realisation"), journals_hold(order.run.output)));
  if (quiet) return 0;
  if (outcome.by_another) {
    print(fmt::format("{} made here\n{}: made by another process of those that joined\n",
                      count_of(outcome.made, "realisation"), file));
    return 0;
  }
  if (outcome.was_complete) {
    print(fmt::format("{}: complete already, nothing to do; --fresh begins anew\n", file));
    return 0;
  }
  if (outcome.before > 0)
    print(fmt::format("{} were there already\n", count_of(outcome.before, "realisation")));
  print(fmt::format("{} in {}", count_of(outcome.made, "realisation"), duration(seconds)));
  if (outcome.made > 0)
    print(fmt::format(": {:.3g}/s on {}", static_cast<double>(outcome.made) / seconds,
                      workers(order)));
  print("\n");
  if (outcome.skipped > 0)
    print(fmt::format("{} of them skipped; /faults in the file says why\n", outcome.skipped));
  if (outcome.estimate) print(estimate_text(*outcome.estimate) + '\n');
  if (outcome.left_out > 0)
    print(fmt::format("{} left out of {}: it is not known there (NaN or infinite){}\n",
                      count_of(outcome.left_out, "realisation"), outcome.question,
                      outcome.unknown.empty() ? "" : ": " + outcome.unknown));
  for (const std::string& note : outcome.notes) print("note: " + note + '\n');
  if (order.run.until) print(until_text(outcome) + '\n');
  print(fmt::format("{}: {}{}\n", file,
                    byte_count(static_cast<double>(std::filesystem::file_size(file))),
                    outcome.complete ? ""
                                     : fmt::format(", not complete: {} of {}", there,
                                                   count_of(outcome.total, "realisation"))));
  return 0;
}

}  // namespace asdic::detail::app
