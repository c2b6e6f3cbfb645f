#include "app/study_comparison.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "app/console.h"
#include "app/output.h"
#include "app/pictures.h"
#include "core/error.h"
#include "core/text.h"
#include "io/files/files_read.h"
#include "io/ping/provenance.h"
#include "io/result/result_file.h"
#include "study/reader/study_reader.h"
#include "study/runs/comparison_file.h"
#include "study/runs/study_file.h"

namespace asdic::detail::app {
namespace {

const study::SummaryTable& table_of(const study::Summary& summary, const std::string& name) {
  return *std::find_if(summary.tables.begin(), summary.tables.end(),
                       [&](const auto& table) { return table.name == name; });
}

std::span<const double> values_of(const study::SummaryTable& table, const std::string& column) {
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (table.columns[i].name == column) return table.values[i];
  return {};
}

std::string significant(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

std::string p_text(double p) {
  if (!std::isfinite(p)) return "-";
  return p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", p);
}

/// Every measure, pair by pair.
std::string answers(const study::Summary& summary, const std::vector<std::string>& names) {
  const study::SummaryTable& table = table_of(summary, "differences");
  Table text({{.name = "measure", .left = true},
              {.name = "A", .left = true},
              {.name = "B", .left = true},
              {.name = "A's"},
              {.name = "B's"},
              {.name = "B - A"},
              {.name = fmt::format("at {:g} %", 100.0 * summary.confidence)},
              {.name = "p"}});
  const auto measures = values_of(table, "measure");
  for (std::size_t row = 0; row < measures.size(); ++row)
    for (std::size_t a = 0; a < names.size(); ++a)
      for (std::size_t b = a + 1; b < names.size(); ++b) {
        const auto at = [&](const std::string& column) { return values_of(table, column)[row]; };
        const std::string pair = names[a] + "_to_" + names[b];
        text.row({table.columns[0].labels[row], names[a], names[b],
                  significant(at("value_" + names[a])), significant(at("value_" + names[b])),
                  significant(at(pair)),
                  significant(at(pair + "_low")) + " to " + significant(at(pair + "_high")),
                  p_text(at(pair + "_p"))});
      }
  return text.text();
}

/// "pd by range, of 10 bins: towed in 7, hull in 1, not decided in 2"
std::string winners(const study::SummaryTable& table, const std::vector<std::string>& names) {
  const auto best = values_of(table, "best");
  std::string text;
  const auto add = [&](const std::string& who, std::ptrdiff_t bins) {
    if (bins > 0) text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", who, bins);
  };
  for (std::size_t k = 0; k < names.size(); ++k)
    add(names[k], std::count(best.begin(), best.end(), static_cast<double>(k)));
  add("not decided",
      std::count_if(best.begin(), best.end(), [](double x) { return std::isnan(x); }));
  std::string what = table.name;
  std::replace(what.begin(), what.end(), '_', ' ');
  return fmt::format("{}, best of {}: {}\n", what, count_of(best.size(), "bin"), text);
}

/// A line a measure: who is best, and by how much more than the next.
std::string winners_by_measure(const study::Comparison& comparison,
                               const std::vector<std::string>& names) {
  const study::SummaryTable& table = table_of(comparison.summary, "differences");
  const auto best = values_of(table, "best");
  std::string text;
  for (std::size_t row = 0; row < best.size(); ++row) {
    const auto at = [&](const std::string& column) { return values_of(table, column)[row]; };
    const study::Better better = comparison.better[row];
    const double sign = better == study::Better::least ? -1.0 : 1.0;
    std::vector<std::size_t> order(names.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return sign * at("value_" + names[a]) > sign * at("value_" + names[b]);
    });
    const std::size_t first = order[0], second = order[1];
    // The pair as the table has it, turned so that it is the better less the other.
    const bool turned = first < second;
    const std::string pair =
        names[std::min(first, second)] + "_to_" + names[std::max(first, second)];
    const double by = turned ? -at(pair) : at(pair);
    const double low = turned ? -at(pair + "_high") : at(pair + "_low");
    const double high = turned ? -at(pair + "_low") : at(pair + "_high");
    const std::string interval = fmt::format("{} ({} to {})", significant(by + 0.0),  // no -0
                                             significant(low + 0.0), significant(high + 0.0));
    const std::string& measure = table.columns[0].labels[row];
    if (!std::isfinite(by))
      text += fmt::format("{}: not known\n", measure);
    else if (by == 0.0 && low == 0.0 && high == 0.0)
      text += fmt::format("{}: the same of {} and {}\n", measure, names[first], names[second]);
    else if (std::isnan(best[row]))
      text += fmt::format("{}: not decided, {} less {} is {}\n", measure, names[first],
                          names[second], interval);
    else
      text += fmt::format("{}: {} is {}, {} less {} is {}\n", measure, names[first],
                          better == study::Better::greatest ? "best"
                          : better == study::Better::least  ? "best (least)"
                                                            : "greatest",
                          names[first], names[second], interval);
  }
  return text;
}

/// The rows of indices below an end.
study::Table first_rows(study::Table table, std::uint64_t end) {
  const auto rows =
      std::lower_bound(table.index.begin(), table.index.end(), end) - table.index.begin();
  table.index.resize(static_cast<std::size_t>(rows));
  table.valid.resize(static_cast<std::size_t>(rows));
  for (study::ColumnValues& column : table.values)
    while (column.size() > table.index.size()) column.pop_back();
  return table;
}

/// What a comparison is made of.
struct Sides {
  std::vector<study::Study> studies{};
  std::vector<std::filesystem::path> files{};
  std::vector<std::string> names{};
};

/// \param end  of the rows that count \param confidence  of its intervals; none: the first study's
study::Comparison compared(const Sides& sides, std::uint64_t end,
                           std::optional<double> confidence = {}) {
  std::vector<study::Study> studies = sides.studies;
  if (confidence) studies.front().summary.confidence = *confidence;
  std::vector<study::Compared> all;
  for (std::size_t k = 0; k < studies.size(); ++k)
    all.push_back({.name = sides.names[k],
                   .study = &studies[k],
                   .table = first_rows(study::StudyFile(sides.files[k]).table(), end)});
  return study::compare(all);
}

/// Whether a file holds these rows of a study already.
bool has_rows(const std::filesystem::path& path, const study::Study& study, std::uint64_t end) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) || filetype_of(path.string()) != "asdic study")
    return false;
  const study::StudyFile file(path);
  return file.fingerprint().identity == study::identity(study) && file.complete() &&
         file.range().first == 0 && file.range().end >= end;
}

/// Makes all of them whole.
int make_whole(const StudyOptions& options, const RunStudy& run) {
  for (const std::string& path : options.paths) {
    StudyOptions one = options;
    one.paths = {path};
    one.output.clear();
    one.pays_no_heed = true;
    if (!options.quiet) print(emphasised(path) + "\n");
    if (const int status = run(one); status != 0) return status;
  }
  return 0;
}

/// Goes on in rounds until the differences are known. \return after how many realisations
std::uint64_t make_rounds(const StudyOptions& options, const Sides& sides,
                          const study::Until& until, const RunStudy& run, std::string& said) {
  std::uint64_t count = sides.studies.front().realisations;
  for (const study::Study& study : sides.studies) count = std::min(count, study.realisations);
  const std::vector<std::uint64_t> rounds = study::rounds_of(sides.studies.front(), count);
  const double confidence = sides.studies.front().summary.confidence;
  const double strict = 1.0 - (1.0 - confidence) / static_cast<double>(rounds.size());
  const bool rules = std::any_of(until.targets().begin(), until.targets().end(),
                                 [](const auto& target) { return target.rule.has_value(); });
  const std::vector<study::Column> columns = study::answer_columns(sides.studies.front());
  bool fresh = options.fresh;
  for (const std::uint64_t end : rounds) {
    for (std::size_t k = 0; k < sides.studies.size(); ++k) {
      if (!fresh && has_rows(sides.files[k], sides.studies[k], end)) continue;
      StudyOptions one = options;
      one.paths = {options.paths[k]};
      one.output = sides.files[k].string();
      forget_read(sides.files[k]);  // of the round before
      one.until.clear();
      one.pays_no_heed = true;
      one.fresh = fresh;
      one.brief = end != rounds.front();
      if (end != sides.studies[k].realisations) one.range = "0:" + std::to_string(end);
      if (!options.quiet && !one.brief) print(emphasised(options.paths[k]) + "\n");
      if (const int status = run(one); status != 0)
        throw RunError(options.paths[k] + " could not be made");
    }
    fresh = false;
    const study::Comparison at_once = compared(sides, end);
    const study::Comparison of_rules = rules ? compared(sides, end, strict) : at_once;
    bool enough = true;
    said.clear();
    for (const study::UntilTarget& target : until.targets()) {
      const study::Known known =
          study::known_difference(columns, target.rule ? of_rules : at_once, sides.names, target);
      enough = enough && known.enough();
      said += "  " + known_text(known) + '\n';
    }
    if (!options.quiet) print(fmt::format("after {}\n{}", count_of(end, "realisation"), said));
    if (!enough && end != rounds.back()) continue;
    said = fmt::format("{} {}\n",
                       enough ? "enough after" : "not as well known as is asked for, after all",
                       count_of(end, "realisation")) +
           said;
    return end;
  }
  return rounds.back();
}

/// The studies' own files have the names that they would have by themselves.
std::vector<std::filesystem::path> files_of(const StudyOptions& options) {
  std::vector<std::filesystem::path> files;
  for (const std::string& path : options.paths) {
    files.emplace_back(std::filesystem::path(path).stem().string() + ".h5");
    if (std::count(files.begin(), files.end(), files.back()) > 1)
      throw InputError({.where = path,
                        .got = "a study whose file would be " + files.back().string() +
                               ", as that of "
                               "another",
                        .expected = "studies of different names"});
  }
  return files;
}

}  // namespace

int compare_studies(const StudyOptions& options, const RunStudy& run) {
  if (options.paths.size() < 2)
    throw InputError({.where = "--compare",
                      .got = "one study",
                      .expected = "two or more: asdic study --compare A.toml B.toml"});
  if (options.assemble || !options.range.empty() || !options.shard.empty())
    throw InputError({.where = "--compare",
                      .got = "--assemble, --realisations or --shard",
                      .expected = "whole studies: make parts and merge them, then compare"});
  Sides sides{.files = files_of(options), .names = study::names_of(options.paths)};
  const auto& files = sides.files;
  const std::vector<std::string>& names = sides.names;
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : "_and_") + name;
  const std::filesystem::path target = options.output.empty()
                                           ? std::filesystem::path(joined + ".h5")
                                           : std::filesystem::path(options.output);
  OutputRules rules = rules_for(target, options.force, options.paths.front());
  for (std::size_t k = 1; k < options.paths.size(); ++k)
    rules.inputs.emplace_back(options.paths[k]);
  rules.inputs.insert(rules.inputs.end(), files.begin(), files.end());
  check_output(target, rules);
  for (const std::string& path : options.paths) {  // all are read before the first is made
    sides.studies.push_back(study::read_study(path, options.overrides));
    study::check_comparable(sides.studies.back());
    if (!sides.studies.back().until.empty())
      tell("asdic: note: " + sides.studies.back().until_where +
           " is not looked at in a comparison; --until is, of the paired difference");
  }
  for (const study::Study& study : sides.studies)
    if (!options.until.empty()) study::check_until(study);
  const study::Until until(sides.studies.front(), options.until);
  for (const study::UntilTarget& asked : until.targets())
    if (asked.over_map)
      throw InputError({.where = "--until",
                        .got = in_quotes(asked.name) + " of a comparison",
                        .expected = "a measure, or one along an axis: a comparison has no maps"});
  std::uint64_t end = std::numeric_limits<std::uint64_t>::max();
  std::string known;
  if (until)
    end = make_rounds(options, sides, until, run, known);
  else if (const int status = make_whole(options, run); status != 0)
    return status;
  std::vector<study::ComparedFile> parts;
  for (std::size_t k = 0; k < files.size(); ++k)
    parts.push_back({.name = names[k],
                     .path = files[k].string(),
                     .fingerprint = study::StudyFile(files[k]).fingerprint()});
  const study::Comparison comparison = compared(sides, end);
  std::string said = fmt::format("{} of {}\n", count_of(comparison.rows, "realisation"), joined) +
                     answers(comparison.summary, names) + winners_by_measure(comparison, names);
  for (const study::SummaryTable& table : comparison.summary.tables)
    if (table.name.starts_with("pd_") || table.name.starts_with("p_"))
      said += winners(table, names);
  said += known;
  const bool stopped = until && end < sides.studies.front().realisations;
  OutputFile output(target, rules);
  study::write_comparison_file(
      output, parts, comparison, said,
      provenance(options.threads.value_or(tbb::info::default_concurrency())),
      stopped ? until.text() : "");
  if (!comparison.unlike_inputs.empty()) {
    std::string list;
    for (const std::string& input : comparison.unlike_inputs)
      list += (list.empty() ? "" : ", ") + input;
    tell("asdic: note: not the same in the rows of all studies: " + list +
         ". Inputs that all vary alike come first in [vary], in one order");
  }
  if (!options.quiet) {
    print(said);
    print(fmt::format("{}: {}\n", target.string(),
                      byte_count(static_cast<double>(std::filesystem::file_size(target)))));
  }
  if (!options.report) return 0;
  flush_output();
  return draw_pictures({target.string(), "--html"});
}

bool is_comparison_file(const std::string& path) { return filetype_of(path) == "asdic comparison"; }

void check_comparison(const std::string& path) { static_cast<void>(study::read_comparison(path)); }

int comparison_info(const std::string& path) {
  const std::string said = study::read_comparison(path);
  print(emphasised("Comparison of studies") +
        fmt::format("\nfile         {}, {}\n", path,
                    byte_count(static_cast<double>(std::filesystem::file_size(path)))));
  print(said);
  print("data         as the manifest says (SHA-256 of every dataset)\n");
  return 0;
}

}  // namespace asdic::detail::app
