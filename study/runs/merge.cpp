#include "study/runs/merge.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "core/error.h"
#include "io/hdf5/own_files.h"

namespace asdic::detail::study {
namespace {

namespace fs = std::filesystem;

/// Rows in a row of one part.
struct Piece {
  std::size_t part = 0, row = 0;  ///< its first row there
  IndexRange range;
};

/// The parts, opened one by one as they are needed: there may be more than files can be open.
class Parts {
 public:
  explicit Parts(const std::vector<fs::path>& paths) : paths_(paths) {}

  [[nodiscard]] const StudyFile& at(std::size_t part) {
    if (!open_ || here_ != part) {
      open_.reset();
      open_ = std::make_unique<StudyFile>(paths_[part]);
      here_ = part;
    }
    return *open_;
  }
  [[nodiscard]] std::string name(std::size_t part) const { return paths_[part].string(); }
  [[nodiscard]] std::size_t size() const noexcept { return paths_.size(); }

 private:
  const std::vector<fs::path>& paths_;
  std::unique_ptr<StudyFile> open_;
  std::size_t here_ = 0;
};

void check_same_study(const StudyFile& part, const Fingerprint& fingerprint,
                      const std::string& first) {
  const Fingerprint& its = part.fingerprint();
  if (its.identity != fingerprint.identity)
    throw InputError(
        {.where = part.path().string(),
         .got = "a part of another study (identity " + its.identity + ")",
         .expected = "one of the study of " + first + " (identity " + fingerprint.identity + ")"});
  if (to_json(its.columns) != to_json(fingerprint.columns))
    throw InputError({.where = part.path().string(),
                      .got = "other columns than " + first + ", by another version of asdic",
                      .expected = "parts of one version"});
}

/// What a part holds, as segments of indices.
void add_pieces(std::size_t part, const std::vector<std::uint64_t>& index,
                std::vector<Piece>& pieces) {
  for (std::size_t row = 0; row < index.size(); ++row) {
    if (row > 0 && index[row] == index[row - 1] + 1)
      pieces.back().range.end = index[row] + 1;
    else
      pieces.push_back({part, row, {index[row], index[row] + 1}});
  }
}

void check_once(const std::vector<Piece>& pieces, const Parts& parts) {
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Piece &a = pieces[i - 1], &b = pieces[i];
    if (b.range.first >= a.range.end) continue;
    const IndexRange both{b.range.first, std::min(a.range.end, b.range.end)};
    throw InputError({.where = parts.name(b.part),
                      .got = "realisations " + index_text(both) + ", which are in " +
                             parts.name(a.part) + " too",
                      .expected = "every realisation in one part"});
  }
}

void check_gaps(const IndexSet& missing, std::uint64_t count) {
  if (missing.empty()) return;
  throw InputError({.where = "merge",
                    .got = "no part with " + std::to_string(missing.size()) + " of " +
                           std::to_string(count) + " realisations: " + index_text(missing),
                    .expected = "all of them, or --allow-gaps"});
}

/// A part that stopped early says so: what it lacks is missing, not forgotten.
struct Gathered {
  Fingerprint fingerprint;
  std::vector<Piece> pieces;
  std::vector<Session> sessions;
};

Gathered gather(Parts& parts) {
  Gathered all;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const StudyFile& part = parts.at(p);
    if (p == 0) all.fingerprint = part.fingerprint();
    check_same_study(part, all.fingerprint, parts.name(0));
    all.fingerprint.realisations =
        std::max(all.fingerprint.realisations, part.fingerprint().realisations);
    part.verify();
    add_pieces(p, part.index(), all.pieces);
    for (const Session& session : part.sessions()) all.sessions.push_back(session);
  }
  std::stable_sort(all.pieces.begin(), all.pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.range.first < b.range.first; });
  return all;
}

/// Appends the rows of one piece.
void add_rows(Table& table, const Table& from, const Piece& piece) {
  const auto cut = [&](auto& into, const auto& column) {
    const auto begin = column.begin() + static_cast<std::ptrdiff_t>(piece.row);
    into.insert(into.end(), begin, begin + static_cast<std::ptrdiff_t>(piece.range.size()));
  };
  cut(table.index, from.index);
  cut(table.valid, from.valid);
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    table.values[i].append(from.values[i].span().subspan(piece.row, piece.range.size()));
    from.values[i].rest();
  }
}

/// Messages of skipped realisations are sorted by their number again.
void sort_faults(std::vector<std::string>& faults) {
  std::stable_sort(faults.begin(), faults.end(), [](const std::string& a, const std::string& b) {
    return std::stoull(a) < std::stoull(b);
  });
  if (faults.size() > most_faults) faults.resize(most_faults);
}

/// The k-th thing of a kind that is kept: part and row there.
struct Kept {
  std::size_t part = 0, row = 0;
};
using AllKept = std::vector<Kept>;

/// Everything but the summary, piece by piece.
class PartsCollector {
 public:
  PartsCollector(Parts& parts, StudyResults& results, SeriesSource& series,
                 std::vector<KeptSource>& kept, const fs::path& folder)
      : parts_(parts),
        results_(results),
        series_(series),
        arrays_(kept),
        folder_(folder),
        kept_arrays_(kept.size()) {}

  void add(const Piece& piece);
  [[nodiscard]] std::vector<CataloguePart> catalogue() && { return std::move(catalogue_); }
  [[nodiscard]] AllKept kept() && { return std::move(kept_); }
  [[nodiscard]] std::vector<AllKept> kept_arrays() && { return std::move(kept_arrays_); }

 private:
  void open(std::size_t part);
  [[nodiscard]] CataloguePart::Kept add_arrays(const Piece& piece, std::size_t kind);

  Parts& parts_;
  StudyResults& results_;
  SeriesSource& series_;
  std::vector<KeptSource>& arrays_;
  fs::path folder_;
  std::vector<CataloguePart> catalogue_;
  AllKept kept_;
  std::vector<AllKept> kept_arrays_;  // [kinds]
  // of the part that is looked at
  std::optional<std::size_t> here_;
  Table table_;
  std::vector<std::uint64_t> series_index_;
  std::vector<std::int32_t> samples_;
  std::vector<SeriesTiming> timing_;
  Shape series_shape_;
  std::vector<KeptReader> readers_;  // [kinds]
};

/// Where indices of a range stand among rising ones.
struct Places {
  std::size_t first = 0, end = 0;
};
Places places_of(const IndexRange& range, const std::vector<std::uint64_t>& index) {
  const auto at = [&](std::uint64_t one) {
    return static_cast<std::size_t>(std::lower_bound(index.begin(), index.end(), one) -
                                    index.begin());
  };
  return {at(range.first), at(range.end)};
}

void PartsCollector::open(std::size_t part) {
  if (here_ == part) return;
  const StudyFile& file = parts_.at(part);
  table_ = file.table();
  series_index_ = file.series_index();
  series_shape_ = file.series_shape();
  samples_ = series_index_.empty() ? std::vector<std::int32_t>{} : file.series_samples();
  timing_ = file.series_timing();
  readers_.clear();
  for (const KeptKind& kind : kept_kinds()) readers_.emplace_back(file, kind);
  here_ = part;
}

CataloguePart::Kept PartsCollector::add_arrays(const Piece& piece, std::size_t kind) {
  const KeptReader& reader = readers_[kind];
  const KeptHeads& told = reader.told();
  const auto [first, end] = places_of(piece.range, told.index);
  for (std::size_t k = first; k < end; ++k) {
    KeptHeads& all = arrays_[kind].told;
    all.index.push_back(told.index[k]);
    all.shapes.push_back(told.shapes[k]);
    all.heads.push_back(told.heads[k]);
    kept_arrays_[kind].push_back({piece.part, k});
  }
  const KeptKind& of = *arrays_[kind].kind;
  CataloguePart::Kept rows{.heads = {first, end - first, {told.index.size()}},
                           .values = {first, end - first, parts_.at(piece.part).kept_shape(of)}};
  if (of.layout == KeptKind::Layout::ragged && end > first) {
    rows.values.first = reader.first_line(first);
    rows.values.rows = reader.first_line(end) - rows.values.first;
  }
  return rows;
}

void PartsCollector::add(const Piece& piece) {
  open(piece.part);
  add_rows(results_.table, table_, piece);
  const auto [first, end] = places_of(piece.range, series_index_);
  for (std::size_t k = first; k < end; ++k) {
    Shape shape(series_shape_.begin() + 1, series_shape_.end());
    shape[sample_axis(shape)] = static_cast<std::size_t>(samples_[k]);
    series_.index.push_back(series_index_[k]);
    series_.shapes.push_back(std::move(shape));
    series_.timing.push_back(timing_[k]);
    kept_.push_back({piece.part, k});
  }
  std::error_code error;
  const fs::path relative = fs::relative(parts_.name(piece.part), folder_, error);
  catalogue_.push_back(
      {.file = error || relative.empty() ? fs::absolute(parts_.name(piece.part)) : relative,
       .table = {piece.row, piece.range.size(), {table_.index.size()}},
       .series = {first, end - first, series_shape_.empty() ? Shape{0} : series_shape_}});
  for (std::size_t kind = 0; kind < arrays_.size(); ++kind)
    catalogue_.back().kept.push_back(add_arrays(piece, kind));
}

}  // namespace

MergeReport merge(const std::vector<fs::path>& paths, OutputFile& output,
                  const SummariseFingerprint& summarise, const MergeOptions& options) {
  Parts parts(paths);
  Gathered all = gather(parts);
  check_once(all.pieces, parts);
  const IndexRange range{0, all.fingerprint.realisations};
  IndexSet there;
  for (const Piece& piece : all.pieces) there.add(piece.range);
  const IndexSet missing = there.missing(range);
  if (!options.allow_gaps) check_gaps(missing, range.size());

  StudyResults results{.fingerprint = all.fingerprint, .range = range, .sessions = all.sessions};
  if (options.text) results.fingerprint.text = *options.text;
  results.table.columns = all.fingerprint.columns;
  results.table.values.resize(all.fingerprint.columns.size());
  SeriesSource series;
  std::vector<KeptSource> arrays;
  for (const KeptKind& kind : kept_kinds()) arrays.push_back({.kind = &kind});
  PartsCollector collector(parts, results, series, arrays,
                           output.target().has_parent_path() ? output.target().parent_path() : ".");
  for (const Piece& piece : all.pieces) collector.add(piece);
  std::vector<CataloguePart> catalogue = std::move(collector).catalogue();
  const AllKept kept = std::move(collector).kept();
  const std::vector<AllKept> kept_arrays = std::move(collector).kept_arrays();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::string& fault : parts.at(p).faults()) results.faults.push_back(std::move(fault));
    sort_faults(results.faults);
    results.table.cells.add(parts.at(p).cells());
  }
  series.pressure = [&](std::size_t k) { return parts.at(kept[k].part).series(kept[k].row); };
  std::optional<KeptReader> reader;  // of the part that is open
  std::pair<std::size_t, std::size_t> reads{};
  for (std::size_t kind = 0; kind < arrays.size(); ++kind)
    arrays[kind].array = [&, kind](std::size_t k) {
      const Kept& one = kept_arrays[kind][k];
      if (const std::pair now{kind, one.part}; !reader || reads != now) {
        reader.emplace(parts.at(one.part), *arrays[kind].kind);
        reads = now;
      }
      return reader->at(one.row);
    };
  results.reuse = take_reuse(results.table);
  results.summary = summarise(results.fingerprint, results.table);
  if (options.copy) catalogue.clear();
  write_study_file(output, results, series, arrays, catalogue);
  MergeReport report{
      .rows = results.table.index.size(), .realisations = range.size(), .missing = missing};
  report.warnings = results.summary.warnings;
  if (std::string mixed = mixed_builds(all.sessions); !mixed.empty())
    report.warnings.push_back(std::move(mixed));
  return report;
}

MergeReport merge(const std::vector<fs::path>& paths, const fs::path& output,
                  const SummariseFingerprint& summarise, const MergeOptions& options) {
  OutputFile file(output, {.own = own::hdf5, .worth = own::pings, .inputs = paths});
  return merge(paths, file, summarise, options);
}

}  // namespace asdic::detail::study
