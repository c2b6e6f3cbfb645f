#include "app/study_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/console.h"
#include "io/result/result_file.h"
#include "study/runs/study_file.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::app {
namespace {

/// "12.3", "1.23e-05"
std::string short_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

/// A line per column: what lies between which values.
std::string columns_of(const study::Table& table) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Table text({{.name = "column", .left = true},
              {.name = "unit", .left = true},
              {.name = "from"},
              {.name = "mean"},
              {.name = "to"},
              {.name = "missing"},
              {.name = "meaning", .left = true}});
  const std::vector<double> weights = study::weights_of(table);  // none: rows of the laws
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    double low = infinity, high = -infinity, sum = 0.0, total = 0.0;
    std::size_t count = 0;
    const bool weighted = !weights.empty() && table.columns[c].role != study::Column::Role::weight;
    for (std::size_t row = 0; row < table.values[c].size(); ++row) {
      const double value = table.values[c][row], weight = weighted ? weights[row] : 1.0;
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
      sum += weight * value;
      total += weight;
      ++count;
    }
    const study::Column& column = table.columns[c];
    text.row({column.name, column.unit, short_number(low),
              short_number(count > 0 ? sum / total : none), short_number(high),
              std::to_string(table.values[c].size() - count), column.meaning});
  }
  return text.text();
}

std::string origin_of(const study::StudyFile& file) {
  const auto run = [&](const std::string& key) {
    return file.file().attribute_or("run", key, "unknown");
  };
  const std::size_t runs = file.sessions().size();
  std::string text = fmt::format("made         {} on {}, {}, {} threads, in {}\n", run("started"),
                                 run("host"), run("cpu"), run("threads"), count_of(runs, "run"));
  return text + fmt::format("by           asdic {}, {}\n",
                            file.file().attribute_text("", "program_version"),
                            file.file().attribute_text("", "build"));
}

}  // namespace

bool is_study_file(const std::string& path) { return filetype_of(path) == "asdic study"; }

int study_info(const std::string& path) {
  const study::StudyFile file(path);
  file.check_parts();
  const study::Fingerprint& fingerprint = file.fingerprint();
  const study::Table table = file.table();
  const auto valid =
      static_cast<std::size_t>(std::count(table.valid.begin(), table.valid.end(), 1));
  print(emphasised(fingerprint.title.empty() ? path : fingerprint.title) + '\n');
  print(fmt::format("file         {}, {}, {}\n", path,
                    byte_count(static_cast<double>(std::filesystem::file_size(path))),
                    file.complete() ? "complete" : "not complete"));
  print(fmt::format("holds        {}, {} of {}", count_of(table.index.size(), "realisation"),
                    study::index_text(file.range()), fingerprint.realisations));
  if (valid < table.index.size()) print(fmt::format("; {} skipped", table.index.size() - valid));
  if (const auto kept = file.series_index(); !kept.empty())
    print(fmt::format("; {} time series", kept.size()));
  for (const study::KeptKind& kind : study::kept_kinds())
    if (const auto kept = file.kept_heads(kind).index; !kept.empty())
      print(fmt::format("; {} of {}", kind.name, count_of(kept.size(), "row")));
  print(file.stopped_by().empty() ? "\n" : "; stopped by " + file.stopped_by() + "\n");
  print(origin_of(file));
  print(fmt::format("study        identity {}, design {}, seed {}\n", fingerprint.identity,
                    fingerprint.design, fingerprint.seed));
  if (!fingerprint.overrides.empty())
    print(fmt::format("changed by   {}\n", file.file().attribute_text("", "overrides")));
  if (study::is_weighted(table))
    print(
        "drawn from   a proposal: means are weighted (sum of wx over sum of w), the ends are those "
        "of what "
        "was drawn\n");
  print(columns_of(table));
  file.verify();  // last: it reads everything; what differs is an error
  print("data         as the manifest says (SHA-256 of every dataset)\n");
  return 0;
}

}  // namespace asdic::detail::app
