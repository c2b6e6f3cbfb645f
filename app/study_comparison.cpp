#include "app/study_comparison.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/console.h"
#include "app/output.h"
#include "app/pictures.h"
#include "core/error.h"
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
  if (!options.until.empty() || options.assemble || !options.range.empty() ||
      !options.shard.empty())
    throw InputError({.where = "--compare",
                      .got = "--until, --assemble, --realisations or --shard",
                      .expected = "whole studies: make parts and merge them, then compare"});
  const auto files = files_of(options);
  const std::vector<std::string> names = study::names_of(options.paths);
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
  std::vector<study::Study> studies;  // all are read before the first is made
  for (const std::string& path : options.paths) {
    studies.push_back(study::read_study(path, options.overrides));
    study::check_comparable(studies.back());
  }
  for (const std::string& path : options.paths) {
    StudyOptions one = options;
    one.paths = {path};
    one.output.clear();
    if (!options.quiet) print(emphasised(path) + "\n");
    if (const int status = run(one); status != 0) return status;
  }
  std::vector<study::Compared> compared;
  std::vector<study::ComparedFile> parts;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const study::StudyFile file(files[k]);
    compared.push_back({.name = names[k], .study = &studies[k], .table = file.table()});
    parts.push_back(
        {.name = names[k], .path = files[k].string(), .fingerprint = file.fingerprint()});
  }
  const study::Comparison comparison = study::compare(compared);
  std::string said = fmt::format("{} of {}\n", count_of(comparison.rows, "realisation"), joined) +
                     answers(comparison.summary, names);
  for (const study::SummaryTable& table : comparison.summary.tables)
    if (table.name.starts_with("pd_")) said += winners(table, names);
  OutputFile output(target, rules);
  study::write_comparison_file(
      output, parts, comparison, said,
      provenance(options.threads.value_or(tbb::info::default_concurrency())));
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
