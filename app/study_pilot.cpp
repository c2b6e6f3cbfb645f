#include "app/study_pilot.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "app/console.h"
#include "app/interrupt.h"
#include "app/progress_bar.h"
#include "app/progress_painter.h"
#include "app/warn.h"
#include "core/error.h"
#include "raytrace/propagation.h"
#include "study/reader/study_reader.h"
#include "study/summary/column_values.h"

namespace asdic::detail::app {
namespace {

using study::Pilot;
using study::Stage;

/// Of rows that take less than a tenth of a second, too.
std::string time_text(double seconds) {
  if (seconds >= 0.1) return duration(seconds);
  return fmt::format("{:.3g} ms", 1e3 * seconds);
}

std::string percent(double share) {
  return fmt::format("{} %", number(100.0 * share, share < 0.0995 ? 1 : 0));
}

double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return study::sample_quantile(values, 0.5);
}

std::string rows_text(const Pilot& pilot) {
  std::vector<double> costs;
  const study::PilotRow* worst = &pilot.rows.front();
  for (const study::PilotRow& row : pilot.rows) {
    costs.push_back(row.cost.total);
    if (row.cost.total > worst->cost.total) worst = &row;
  }
  const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
  return fmt::format(
      "row        {} of processor time at the median, {} at the mean, {} to {}; the dearest is "
      "realisation {}\n",
      time_text(middle(costs)), time_text(pilot.mean.total), time_text(*least), time_text(*most),
      worst->index);
}

std::string whole_text(const Pilot& pilot, int threads) {
  const study::Predicted& all = pilot.processor;
  const std::string rows = count_of(pilot.count, "realisation");
  std::string text = fmt::format("whole      {}: {} of processor time", rows, duration(all.total));
  if (std::isfinite(all.interval.high))
    text += fmt::format(", {} to {} (95 %); journal and file come on top\n",
                        duration(all.interval.low), duration(all.interval.high));
  else if (std::isfinite(all.interval.low))
    text += fmt::format(
        ", {} at the least (95 %); so few or so uneven rows set no upper bound; journal and file "
        "come on top\n",
        duration(all.interval.low));
  else
    text += "; of a single row nothing tells how sure that is\n";
  if (threads > 1)
    text += fmt::format(
        "           {} on {} threads at the least: if each has a core of its own and none waits "
        "for memory\n",
        duration(all.total / threads), threads);
  if (pilot.rows.size() < pilot.count && pilot.rows.size() < 6)
    text += "           of so few rows whole kinds of them may be missing: 16 tell more\n";
  else if (pilot.rows.size() < pilot.count)
    text += fmt::format(
        "           a kind of row that is rarer than one in {} may not be among those tried\n",
        pilot.rows.size() / 3);
  if (pilot.again < 0.9)
    text += fmt::format(
        "           a row whose conditions were met before costs {} of that: where conditions come "
        "again, the whole costs less\n",
        percent(pilot.again));
  return text;
}

std::string memory_text(const Pilot& pilot, int threads) {
  constexpr double shared = 1.5 * study::Realiser::shared_bytes;  // with what malloc adds
  const double base = pilot.base_memory + shared;
  const study::Predicted& most = pilot.row_most;
  if (std::isnan(pilot.row_memory))
    return "memory     not known: this system does not tell what a row takes\n";
  std::string text =
      fmt::format("memory     {}: {} the program, {} what rows share, {} a row and thread",
                  byte_count(base + threads * most.total), byte_count(pilot.base_memory),
                  byte_count(shared), byte_count(most.total));
  if (most.interval.high > 1.05 * std::max(pilot.row_memory, most.interval.low))
    text += fmt::format(
        ";\n           the dearest row tried takes {}, the dearest of all {} to {} (95 %)",
        byte_count(pilot.row_memory), byte_count(most.interval.low),
        byte_count(most.interval.high));
  else if (std::isnan(most.interval.high))
    text += " at least; more rows tell how much";
  if (threads * most.total > pilot.budget)
    text += fmt::format("; rows wait for one another, as run.memory allows {}",
                        byte_count(pilot.budget));
  const double rows = static_cast<double>(pilot.count);
  constexpr double in_memory = study::ColumnValues::most_in_memory;
  const double summary = std::min(rows, in_memory) * pilot.file_row + 160.0 * rows;
  text +=
      fmt::format("\n           and up to {} for the summary at the end\n", byte_count(summary));
  return text;
}

std::string file_text(const Pilot& pilot) {
  std::string text = fmt::format("file       {} a row", byte_count(pilot.file_row));
  if (pilot.kept_row > 0.0)
    text += fmt::format(" and {} that rows keep beside it", byte_count(pilot.kept_row));
  text += fmt::format(
      ": {}", byte_count(static_cast<double>(pilot.count) * (pilot.file_row + pilot.kept_row)));
  if (!pilot.kept_met) text += ", and what else rows keep, of which none was met";
  return text + "; a journal of about as much while it runs\n";
}

std::string stages_text(const Pilot& pilot) {
  std::string text = "\nwhere a row's time goes\n";
  std::vector<std::pair<double, Stage>> stages;
  double told = 0.0;
  for (int s = 0; s < static_cast<int>(Stage::count); ++s) {
    const double share = pilot.mean[static_cast<Stage>(s)] / pilot.mean.total;
    told += share;
    if (share >= 0.005) stages.emplace_back(share, static_cast<Stage>(s));
  }
  std::sort(stages.begin(), stages.end(),
            [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [share, stage] : stages)
    text += fmt::format("  {:>6}  {}\n", percent(share), name(stage));
  if (1.0 - told >= 0.005) text += fmt::format("  {:>6}  the rest\n", percent(1.0 - told));
  return text;
}

std::string drivers_text(const Pilot& pilot) {
  if (pilot.ordered == 0) return "";
  std::string text =
      "\nwhat makes a row dear (rank correlation of its cost, all intervals together 95 %)\n";
  for (const study::CostDriver& driver : pilot.drivers)
    text += fmt::format("  {:+.2f}   {} ({:+.2f} to {:+.2f})\n", driver.rank.value, driver.input,
                        driver.rank.low, driver.rank.high);
  if (pilot.drivers.empty())
    text += fmt::format("  none of {} stands out among {} rows\n", count_of(pilot.ordered, "input"),
                        pilot.rows.size());
  return text;
}

std::string set_text(const study::Candidate& candidate) {
  std::string set;
  for (const std::string& one : candidate.overrides) {
    if (one == "measure.echo_level=true") continue;  // something has to be measured
    set += (set.empty() ? "" : ", ") + one;
  }
  return set;
}

std::string turned_text(const Pilot& pilot) {
  constexpr double felt = 0.05;  // of a row's cost: less may be the clock's own scatter
  std::string text = "\nwhat to turn: each alone, on the same rows\n", idle;
  for (const study::Turned& turned : pilot.turned) {
    const std::string set = set_text(turned.candidate);
    if (turned.share > 1.0 - felt) {
      idle += (idle.empty() ? "" : ", ") + set;
      continue;
    }
    text += fmt::format("  {:>6} of the time with {}\n          lost: {}\n", percent(turned.share),
                        set, turned.candidate.loses);
  }
  if (!idle.empty()) text += wrapped("  next to nothing is saved by " + idle, 100, 4);
  std::string refused;
  for (const study::Candidate& one : pilot.refused)
    refused += (refused.empty() ? "" : ", ") + set_text(one);
  if (!refused.empty())
    text += wrapped("  cannot be tried by itself, as other keys ask for it: " + refused, 100, 4);
  return pilot.turned.empty() && pilot.refused.empty() ? "" : text;
}

}  // namespace

std::string pilot_text(const Pilot& pilot, int threads) {
  return fmt::format("pilot      {}, one at a time on one thread; nothing is written\n",
                     count_of(pilot.rows.size(), "realisation")) +
         rows_text(pilot) + whole_text(pilot, threads) + memory_text(pilot, threads) +
         file_text(pilot) + stages_text(pilot) + drivers_text(pilot) + turned_text(pilot);
}

int try_study(const StudyOptions& options) {
  if (options.paths.size() != 1 || options.compare || options.join || options.assemble ||
      options.report || !options.until.empty() || !options.range.empty() ||
      !options.shard.empty() || !options.output.empty())
    throw InputError({.where = "--pilot",
                      .got = "several studies, or -o, --until, --compare, --join, --assemble, "
                             "--report, --realisations or --shard beside it",
                      .expected = "one study: it makes nothing but an estimate of the whole"});
  const study::Study study = study::read_study(options.paths.front(), options.overrides);
  if (!options.quiet) warn(study.warnings);
  const StopOnInterrupt interrupt("asdic: stopping: nothing was written");
  std::mutex mutex;
  double share = 0.0;
  std::optional<ProgressPainter> painter(
      std::in_place, !options.quiet, [&](double elapsed, std::size_t width) {
        const std::lock_guard lock(mutex);
        return fitted_line(share, {{"pilot", 0}, {duration(elapsed), 1}}, width);
      });
  study::PilotOptions how{.rows = static_cast<std::uint64_t>(*options.pilot),
                          .set = options.overrides,
                          .stop = interrupt.token()};
  how.progress = [&](std::uint64_t done, std::uint64_t of) {
    const std::lock_guard lock(mutex);
    share = static_cast<double>(done) / static_cast<double>(of);
  };
  Pilot pilot;
  try {
    pilot = study::pilot(study, how);
  } catch (const Interrupted&) {
    throw RunError("interrupted: a pilot that is not done tells nothing");
  }
  painter.reset();
  print(pilot_text(pilot, options.threads.value_or(tbb::info::default_concurrency())));
  return 0;
}

}  // namespace asdic::detail::app
