#include "study/runs/study_file.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "io/files/digest.h"

namespace asdic::detail::study {
namespace {

using Json = nlohmann::json;

/// Opens a file whose root says that it is a study's.
Hdf5File open_study(const std::filesystem::path& path) {
  Hdf5File file = Hdf5File::open(path);
  const auto attribute = [&](const char* key) {
    return file.has_attribute("", key) ? file.attribute_text("", key) : std::string();
  };
  if (const std::string type = attribute("filetype"); type != "asdic study")
    throw InputError(
        {.where = path.string(),
         .got = type.empty() ? "an HDF5 file without a filetype" : "filetype \"" + type + "\"",
         .expected = "filetype \"asdic study\""});
  if (const std::string version = attribute("version"); !version.starts_with("1."))
    throw InputError({.where = path.string(),
                      .got = "version \"" + version + "\" of the format",
                      .expected = "version 1"});
  if (!file.has("manifest"))
    throw InputError({.where = path.string(),
                      .got = "no manifest",
                      .expected = "a whole file of asdic study or asdic merge"});
  return file;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

InputError no_manifest(const std::filesystem::path& path, const std::exception& error) {
  return InputError({.where = path.string() + ": manifest",
                     .got = std::string("what cannot be read (") + error.what() + ")",
                     .expected = "the manifest of a study's file"});
}

}  // namespace

StudyFile::StudyFile(const std::filesystem::path& path)
    : file_(open_study(path)), manifest_(file_.read_text("manifest")) {
  try {
    const Json manifest = Json::parse(manifest_);
    range_ = {manifest.at("first"), manifest.at("end")};
    complete_ = manifest.at("complete");
    fingerprint_ = {
        .identity = manifest.at("identity"),
        .title = file_.attribute_text("", "title"),
        .seed = std::stoull(file_.attribute_text("", "seed")),
        .realisations = static_cast<std::uint64_t>(file_.attribute_number("", "realisations")),
        .design = file_.attribute_text("", "design"),
        .text = file_.read_text("study"),
        .scenario_text = file_.read_text("scenario"),
        .origin = read_origin_attributes(file_),
        .overrides = file_.has_attribute("", "overrides") ? file_.attribute_texts("", "overrides")
                                                          : std::vector<std::string>{},
        .warnings = file_.has_attribute("", "warnings") ? file_.attribute_texts("", "warnings")
                                                        : std::vector<std::string>{},
        .left_out_db = file_.has_attribute("", "left_out_db")
                           ? file_.attribute_number("", "left_out_db")
                           : std::numeric_limits<double>::quiet_NaN(),
        .columns = columns_from_json(manifest.at("columns").dump())};
  } catch (const Json::exception& error) {
    throw no_manifest(path, error);
  } catch (const std::logic_error& error) {  // of std::stoull
    throw no_manifest(path, error);
  }
}

std::span<const SeriesDataset> series_datasets() {
  static constexpr std::array<SeriesDataset, 4> all{
      {{"sample_rate", "Hz", "samples a second", &SeriesTiming::sample_rate},
       {"start", "s", "of the first sample, after the ping's start", &SeriesTiming::start},
       {"carrier", "Hz", "of complex baseband; 0: real pressure", &SeriesTiming::carrier},
       {"epoch", "s", "of the ping, on the clock that the carrier runs by", &SeriesTiming::epoch}}};
  return all;
}

std::string StudyFile::stopped_by() const {
  return file_.has_attribute("", "stopped_by") ? file_.attribute_text("", "stopped_by") : "";
}

std::vector<Session> StudyFile::sessions() const {
  std::vector<Session> all;
  try {
    for (const std::string& line : lines_of(file_.read_text("run/sessions")))
      all.push_back(session_from_json(line));
  } catch (const Json::exception& error) {
    throw no_manifest(path(), error);
  }
  return all;
}

std::vector<std::string> StudyFile::faults() const { return lines_of(file_.read_text("faults")); }

std::vector<std::uint64_t> StudyFile::index() const {
  const auto values = file_.read<std::int64_t>("index");
  return {values.begin(), values.end()};
}

Table StudyFile::table() const {
  Table table{.columns = fingerprint_.columns, .index = index(), .valid = {}, .values = {}};
  const auto valid = file_.read<std::int8_t>("valid");
  table.valid.assign(valid.begin(), valid.end());
  for (const Column& column : table.columns)
    table.values.push_back(file_.read<double>(
        (column.role == Column::Role::reuse ? "run/reuse/" : "table/") + column.name));
  table.cells = cells();
  return table;
}

Table StudyFile::own() const {
  Table table{};
  try {
    const Json manifest = Json::parse(manifest_);
    if (manifest.contains("own")) table.columns = columns_from_json(manifest.at("own").dump());
  } catch (const Json::exception& error) {
    throw no_manifest(path(), error);
  }
  for (const Column& column : table.columns)
    table.values.push_back(file_.read<double>("table/" + column.name));
  return table;
}

CellSums StudyFile::cells() const {
  if (!file_.has("cells/count")) return {};
  std::vector<double> edges = file_.read<double>("cells/time_low");
  const std::vector<double> ends = file_.read<double>("cells/time_high");
  if (edges.size() < 2 || ends.size() != edges.size()) return {};
  edges.erase(edges.begin());  // of all times together
  edges.push_back(ends.back());
  CellSums sums = cell_sums({.targets = file_.info("cells/realisations").shape.front(),
                             .edges = std::move(edges),
                             .levels = file_.read<double>("cells/level")});
  const auto read = [&](const char* name, std::vector<std::int64_t>& into) {
    std::vector<std::int64_t> values = file_.read<std::int64_t>(std::string("cells/") + name);
    if (values.size() == into.size()) into = std::move(values);
  };
  read("count", sums.count);
  read("squares", sums.squares);
  read("with_all", sums.with_all);
  read("realisations", sums.realisations);
  return sums;
}

std::vector<std::uint64_t> StudyFile::series_index() const {
  if (!file_.has("time_series/index")) return {};
  const auto values = file_.read<std::int64_t>("time_series/index");
  return {values.begin(), values.end()};
}

Shape StudyFile::series_shape() const {
  return file_.has("time_series/pressure") ? file_.info("time_series/pressure").shape : Shape{};
}

std::vector<std::int32_t> StudyFile::series_samples() const {
  return file_.read<std::int32_t>("time_series/valid_samples");
}

std::vector<SeriesTiming> StudyFile::series_timing() const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<SeriesTiming> all(series_index().size(), {none, none, none, none});
  for (const SeriesDataset& dataset : series_datasets()) {
    const std::string path = std::string("time_series/") + dataset.name;
    if (!file_.has(path)) continue;
    const auto values = file_.read<double>(path);
    for (std::size_t k = 0; k < all.size(); ++k) all[k].*dataset.value = values.at(k);
  }
  return all;
}

std::vector<float> StudyFile::series(std::size_t k) const {
  Shape count = series_shape();
  if (count.size() < 2)
    throw InputError({.where = path().string() + ": time_series/pressure",
                      .got = std::to_string(count.size()) + " dimensions",
                      .expected = "(series, channel, sample), or with iq"});
  Shape start(count.size(), 0);
  start[0] = k;
  count[0] = 1;
  const auto samples = file_.read<std::int32_t>("time_series/valid_samples", {k}, {1});
  count[1 + sample_axis({count.begin() + 1, count.end()})] =
      static_cast<std::size_t>(samples.front());
  return file_.read<float>("time_series/pressure", start, count);
}

KeptHeads StudyFile::kept_heads(const KeptKind& kind) const {
  const std::string group = std::string(kind.name) + '/';
  KeptHeads told;
  if (!file_.has(group + "index")) return told;
  const auto index = file_.read<std::int64_t>(group + "index");
  told.index.assign(index.begin(), index.end());
  const auto count = file_.read<std::int32_t>(group + kind.count.name);
  const Shape all = kept_shape(kind);
  const bool padded = kind.layout == KeptKind::Layout::padded;
  std::size_t lines = 0;
  bool fits = count.size() == index.size() && all.size() == (padded ? 3U : 1U);
  for (const std::int32_t n : count) {
    fits = fits && n >= 0 && (!padded || static_cast<std::size_t>(n) <= all[2]);
    lines += static_cast<std::size_t>(std::max(n, 0));
  }
  if (!fits || all[0] != (padded ? index.size() : lines))
    throw InputError({.where = path().string() + ": " + group + kind.count.name,
                      .got = "numbers that do not fit the values",
                      .expected = "those that asdic study wrote"});
  for (const std::int32_t n : count)
    told.shapes.push_back(padded ? Shape{all[1], static_cast<std::size_t>(n)}
                                 : Shape{static_cast<std::size_t>(n), kind.values.size()});
  told.heads.resize(index.size());
  for (const KeptColumn& column : kind.head) {
    const auto values = file_.read<double>(group + column.name);
    for (std::size_t k = 0; k < index.size(); ++k) told.heads[k].push_back(values.at(k));
  }
  return told;
}

Shape StudyFile::kept_shape(const KeptKind& kind) const {
  const std::string dataset = std::string(kind.name) + '/' + kind.values.front().name;
  return file_.has(dataset) ? file_.info(dataset).shape : Shape{0};
}

KeptReader::KeptReader(const StudyFile& file, const KeptKind& kind)
    : file_(file), kind_(kind), told_(file.kept_heads(kind)) {
  if (kind.layout == KeptKind::Layout::padded) return;
  first_line_.assign(1, 0);
  for (const Shape& shape : told_.shapes) first_line_.push_back(first_line_.back() + shape[0]);
}

/// The lines of the k-th and of those behind it.
void KeptReader::read_lines(std::size_t k) {
  constexpr std::size_t together = std::size_t{1} << 14;
  first_ = first_line_[k];
  end_ = std::max(first_line_[k + 1], std::min(first_line_.back(), first_ + together));
  lines_.clear();
  for (const KeptColumn& column : kind_.values)
    lines_.push_back(file_.file().read<double>(std::string(kind_.name) + '/' + column.name,
                                               {first_}, {end_ - first_}));
}

KeptArray KeptReader::at(std::size_t k) {
  KeptArray made{
      .name = std::string(kind_.name), .shape = told_.shapes.at(k), .head = told_.heads.at(k)};
  if (kind_.layout == KeptKind::Layout::padded) {
    made.values = file_.file().read<double>(std::string(kind_.name) + '/' + kind_.values[0].name,
                                            {k, 0, 0}, {1, made.shape[0], made.shape[1]});
    return made;
  }
  if (made.shape[0] == 0) return made;
  if (first_line_[k] < first_ || first_line_[k + 1] > end_) read_lines(k);
  for (std::size_t line = first_line_[k]; line < first_line_[k + 1]; ++line)
    for (const std::vector<double>& column : lines_) made.values.push_back(column[line - first_]);
  return made;
}

namespace {

template <class T>
void add(Digest& digest, const Hdf5File& file, const DatasetInfo& info) {
  constexpr std::size_t at_a_time = std::size_t{1} << 22;  // elements: memory stays flat
  std::size_t row = 1;
  for (std::size_t i = 1; i < info.shape.size(); ++i) row *= info.shape[i];
  const std::size_t rows = std::max<std::size_t>(1, at_a_time / std::max<std::size_t>(row, 1));
  Shape start(info.shape.size(), 0), count = info.shape;
  if (info.shape.empty()) return digest.add(std::span<const T>(file.read<T>(info.path)));
  for (; start[0] < info.shape[0]; start[0] += count[0]) {
    count[0] = std::min(rows, info.shape[0] - start[0]);
    const std::vector<T> values = file.read<T>(info.path, start, count);
    digest.add(std::span<const T>(values));
  }
}

std::string digest_of(const Hdf5File& file, const std::string& dataset) {
  const DatasetInfo info = file.info(dataset);
  Digest digest;
  switch (info.type) {
    case ElementType::text: {
      const std::string text = file.read_text(dataset);
      digest.add(std::span<const char>(text));
      break;
    }
    case ElementType::int8:
      add<std::int8_t>(digest, file, info);
      break;
    case ElementType::int32:
      add<std::int32_t>(digest, file, info);
      break;
    case ElementType::int64:
      add<std::int64_t>(digest, file, info);
      break;
    case ElementType::float32:
      add<float>(digest, file, info);
      break;
    default:
      add<double>(digest, file, info);
  }
  return digest.text();
}

}  // namespace

std::vector<std::filesystem::path> StudyFile::parts() const {
  std::vector<std::filesystem::path> all = file_.virtual_files("index");
  for (std::filesystem::path& part : all) part = path().parent_path() / part;
  return all;
}

void StudyFile::check_parts() const {
  std::error_code error;
  for (const std::filesystem::path& part : parts())
    if (!std::filesystem::exists(part, error))
      throw InputError({.where = path().string(),
                        .got = "no " + part.string() + ", in which some of its rows lie",
                        .expected = "all parts of the catalogue where they were when it was "
                                    "merged; asdic merge --copy makes one file of them"});
}

/// Of a catalogue whose data differ: the part that is not what it was.
void StudyFile::check_each_part() const {
  for (const std::filesystem::path& name : parts()) {
    const StudyFile part(name);
    part.verify();
    if (part.fingerprint().identity != fingerprint_.identity)
      throw InputError(
          {.where = name.string(),
           .got = "a part of another study (identity " + part.fingerprint().identity + ")",
           .expected = "the one that " + path().string() + " was merged of (identity " +
                       fingerprint_.identity + ")"});
  }
}

namespace {

/// What a manifest tells of a dataset.
struct Told {
  std::string dataset, sha256;
  Shape shape;
};

std::vector<Told> told_by(const std::string& manifest) {
  std::vector<Told> all;
  const Json json = Json::parse(manifest);  // outlives the loop
  for (const auto& [dataset, told] : json.at("datasets").items())
    all.push_back({dataset, told.at("sha256"), told.at("shape")});
  return all;
}

/// "" for data that HDF5 itself finds damaged.
std::string digest_if_readable(const Hdf5File& file, const std::string& dataset) {
  try {
    return digest_of(file, dataset);
  } catch (const RunError&) {
    return "";
  }
}

}  // namespace

void StudyFile::verify() const {
  check_parts();
  std::vector<Told> all;
  try {
    all = told_by(manifest_);
  } catch (const Json::exception& error) {
    throw no_manifest(path(), error);
  }
  for (const auto& [dataset, sum, shape] : all) {
    const std::string where = path().string() + ": " + dataset;
    if (!file_.has(dataset))
      throw InputError(
          {.where = where, .got = "no such dataset", .expected = "what the manifest lists"});
    if (file_.info(dataset).shape == shape && digest_if_readable(file_, dataset) == sum) continue;
    check_each_part();
    throw InputError({.where = where,
                      .got = "data that have changed since they were written",
                      .expected = "those of the manifest (SHA-256 " + sum.substr(0, 12) + "…)"});
  }
}

}  // namespace asdic::detail::study
