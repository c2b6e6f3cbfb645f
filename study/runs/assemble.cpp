#include "study/runs/assemble.h"

#include <algorithm>

namespace asdic::detail::study {
namespace {

void add(Table& table, const Row& row) {
  table.index.push_back(row.index);
  table.valid.push_back(row.valid ? 1 : 0);
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    table.values[i].push_back(row.values.at(i));
  if (row.valid && !table.cells.empty()) table.cells.add(std::span<const std::uint8_t>(row.cells));
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::vector<Segment> segments(const std::vector<const Journal*>& journals, IndexRange range) {
  std::vector<Segment> all;
  IndexSet taken;
  for (std::size_t j = 0; j < journals.size(); ++j) {
    const IndexSet here = journals[j]->done().within(range);
    IndexSet more;
    for (const IndexRange& segment : here.ranges()) {
      const IndexSet open = taken.missing(segment);
      for (const IndexRange& piece : open.ranges()) {
        all.push_back({piece, j});
        more.add(piece);  // they come in a row
      }
    }
    taken.add(more);
  }
  std::sort(all.begin(), all.end(),
            [](const Segment& a, const Segment& b) { return a.range.first < b.range.first; });
  return all;
}

bool assemble(OutputFile& output, const Fingerprint& fingerprint, IndexRange range,
              const std::vector<const Journal*>& journals, const Summarise& summarise,
              const std::string& stopped_by, std::vector<std::string>* warnings) {
  StudyResults results{.fingerprint = fingerprint, .range = range, .stopped_by = stopped_by};
  results.table.columns = fingerprint.columns;
  results.table.values.resize(fingerprint.columns.size());
  results.table.cells = cell_sums(fingerprint.cells);
  SeriesSource series;
  std::vector<std::size_t> home;  // [kept] which journal
  std::vector<KeptSource> kept;
  std::vector<std::vector<std::size_t>> home_of;  // [kinds][kept]
  for (const KeptKind& kind : kept_kinds()) kept.push_back({.kind = &kind});
  home_of.resize(kept.size());
  for (const Journal* journal : journals) results.table.cells.add(journal->imported_cells());
  for (const Segment& segment : segments(journals, range)) {
    const Journal& journal = *journals[segment.journal];
    journal.rows(segment.range, false, [&](Row&& row) {
      add(results.table, row);
      if (!row.valid && results.faults.size() < most_faults)
        results.faults.push_back(std::to_string(row.index) + ": " + one_line(row.fault));
    });
    journal.series(segment.range, [&](Row&& row) {
      series.index.push_back(row.index);
      series.shapes.push_back(std::move(row.pressure_shape));
      series.timing.push_back(row.timing);
      home.push_back(segment.journal);
    });
    for (std::size_t i = 0; i < kept.size(); ++i)
      journal.arrays(segment.range, kept[i].kind->name,
                     [&](std::uint64_t index, KeptArray&& array) {
                       kept[i].told.index.push_back(index);
                       kept[i].told.shapes.push_back(std::move(array.shape));
                       kept[i].told.heads.push_back(std::move(array.head));
                       home_of[i].push_back(segment.journal);
                     });
  }
  series.pressure = [&](std::size_t k) { return journals[home[k]]->pressure(series.index[k]); };
  for (std::size_t i = 0; i < kept.size(); ++i)
    kept[i].array = [&, i](std::size_t k) {
      return journals[home_of[i][k]]->array(kept[i].told.index[k], kept[i].kind->name);
    };
  for (const Journal* journal : journals)
    for (const Session& session : journal->sessions()) results.sessions.push_back(session);
  results.reuse = take_reuse(results.table);
  results.summary = summarise(results.table);
  if (warnings != nullptr) *warnings = results.summary.warnings;
  write_study_file(output, results, series, kept);
  return results.complete();
}

}  // namespace asdic::detail::study
