#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "core/error.h"
#include "io/digest.h"
#include "io/hdf5/scale.h"
#include "study/study_file.h"

namespace asdic::study {
namespace {

using Json = nlohmann::json;

std::size_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

/// Different texts, in order.
std::vector<std::string> different(const std::vector<Session>& sessions,
                                   const std::function<std::string(const Session&)>& text) {
  std::set<std::string> all;
  for (const Session& session : sessions)
    if (session.rows > 0) all.insert(text(session));
  return {all.begin(), all.end()};
}

std::string joined(const std::vector<std::string>& texts) {
  std::string result;
  for (const std::string& text : texts) result += (result.empty() ? "" : "; ") + text;
  return result;
}

class Writer {
 public:
  Writer(const std::filesystem::path& path, const StudyResults& results,
         const std::vector<CataloguePart>& catalogue)
      : file_(Hdf5File::create(path)), results_(results), catalogue_(catalogue) {}

  void write(const SeriesSource& series) {
    write_root();
    write_table();
    write_series(series);
    write_summary();
    write_manifest();
    write_run();
    file_.close();
  }

 private:
  void write_root();
  void write_table();
  void write_series(const SeriesSource& series);
  void write_summary();
  void write_manifest();
  void write_run();
  void write_pressure(const SeriesSource& series, const Shape& row);

  /// Notes a dataset in the manifest.
  void note(const std::string& dataset, const Shape& shape, const std::string& sha256) {
    manifest_[dataset] = {{"shape", shape}, {"sha256", sha256}};
  }

  /// A column, here or in the parts.
  template <class T>
  void column(const std::string& dataset, const std::vector<T>& values, T fill,
              bool series = false) {
    const Shape shape{values.size()};
    if (catalogue_.empty()) {
      file_.write<T>(dataset, values, shape);
    } else {
      std::vector<VirtualRows> parts;
      for (const CataloguePart& part : catalogue_)
        parts.push_back({.file = part.file,
                         .dataset = "/" + dataset,
                         .shape = {series ? part.series_shape.at(0) : part.all_rows},
                         .first = series ? part.first_series : part.first,
                         .rows = series ? part.series_rows : part.rows});
      file_.write_virtual<T>(dataset, shape, parts, fill);
    }
    noted(dataset, values);
  }

  template <class T>
  void noted(const std::string& dataset, const std::vector<T>& values) {
    Digest digest;
    digest.add(std::span<const T>(values));
    note(dataset, {values.size()}, digest.text());
  }

  void text(const std::string& dataset, const std::string& value, const std::string& long_name) {
    file_.write_text(dataset, value);
    describe(file_, dataset, long_name);
    Digest digest;
    digest.add(std::span<const char>(value));
    note(dataset, {}, digest.text());
  }

  void describe_column(const std::string& dataset, const Column& column) {
    describe(file_, dataset, column.meaning, column.unit);
    if (!column.labels.empty()) file_.set_attribute(dataset, "labels", column.labels);
  }

  Hdf5File file_;
  const StudyResults& results_;
  const std::vector<CataloguePart>& catalogue_;
  Json manifest_ = Json::object();
};

void Writer::write_root() {
  const Imprint& imprint = results_.imprint;
  file_.set_attribute("", "filetype", "asdic study");
  file_.set_attribute("", "version", "1.0");
  file_.set_attribute("", "title", imprint.title);
  file_.set_attribute("", "identity", imprint.identity);
  file_.set_attribute("", "seed", std::to_string(imprint.seed));
  file_.set_attribute("", "design", imprint.design);
  file_.set_attribute("", "realisations", static_cast<std::int64_t>(imprint.realisations));
  file_.set_attribute("", "complete", std::int64_t{results_.complete()});
  if (!results_.stopped_by.empty()) file_.set_attribute("", "stopped_by", results_.stopped_by);
  if (!imprint.overrides.empty()) file_.set_attribute("", "overrides", imprint.overrides);
  const auto& sessions = results_.sessions;
  const auto version = [](const Session& s) { return s.made.program_version; };
  const auto build = [](const Session& s) { return s.made.build; };
  file_.set_attribute("", "program_version", joined(different(sessions, version)));
  file_.set_attribute("", "build", joined(different(sessions, build)));
  text("study", imprint.text, "the study file, verbatim");
  text("scenario", imprint.scenario_text, "the scenario file, verbatim");
}

void Writer::write_table() {
  const Table& table = results_.table;
  // HDF5 has no std::uint64_t among ours; indices are far below 2⁶³.
  const std::vector<std::int64_t> index(table.index.begin(), table.index.end());
  const std::vector<std::int8_t> valid(table.valid.begin(), table.valid.end());
  column<std::int64_t>("index", index, -1);
  describe(file_, "index", "realisation, counted from 0");
  file_.make_scale("index", "realisation");
  column<std::int8_t>("valid", valid, 0);
  describe(file_, "valid", "0: skipped, its measures are NaN");
  file_.attach_scales("valid", {"index"});
  file_.make_group("table");
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const Column& c = table.columns[i];
    const std::string path = "table/" + c.name;
    column<double>(path, table.values[i], std::numeric_limits<double>::quiet_NaN());
    describe_column(path, c);
    file_.set_attribute(path, "role", c.role == Column::Role::input ? "input" : "measure");
    file_.attach_scales(path, {"index"});
  }
  std::string faults;
  for (const std::string& fault : results_.faults) faults += fault + "\n";
  text("faults", faults, "why realisations were skipped, \"index: reason\" a line, the first 1000");
}

void Writer::write_series(const SeriesSource& series) {
  if (series.index.empty()) return;
  Shape row = series.shapes.front();  // the longest
  const std::size_t axis = sample_axis(row);
  std::vector<std::int32_t> samples;
  for (const Shape& shape : series.shapes) {
    Shape same = shape;
    same.resize(std::max(shape.size(), axis + 1));
    samples.push_back(static_cast<std::int32_t>(same[axis]));
    row[axis] = std::max(row[axis], same[axis]);
    same[axis] = row[axis];
    if (same != row)
      throw RunError("time series of different numbers of channels cannot lie in one dataset");
  }
  const std::vector<std::int64_t> index(series.index.begin(), series.index.end());
  column<std::int64_t>("time_series/index", index, -1, true);
  describe(file_, "time_series/index", "realisation, counted from 0");
  file_.make_scale("time_series/index", "kept");
  column<std::int32_t>("time_series/valid_samples", samples, 0, true);
  describe(file_, "time_series/valid_samples", "samples before the padding");
  write_pressure(series, row);
  describe(file_, "time_series/pressure", "what the phones hear; complex where the last axis is 2",
           "Pa");
  file_.attach_scales("time_series/pressure", {"time_series/index"});
}

/// The time series one by one: they are never held together.
void Writer::write_pressure(const SeriesSource& series, const Shape& row) {
  const std::string path = "time_series/pressure";
  const std::size_t axis = sample_axis(row);
  const std::size_t inner =
      product({row.begin() + static_cast<std::ptrdiff_t>(axis) + 1, row.end()});
  const std::size_t lines = product(row) / std::max<std::size_t>(row[axis] * inner, 1);
  Shape all(row.size() + 1, 1);  // first of one, then of all
  std::copy(row.begin(), row.end(), all.begin() + 1);
  const Shape chunk = all;
  all[0] = series.index.size();
  if (catalogue_.empty()) {
    file_.create_growing<float>(path, row, chunk);
  } else {
    std::vector<VirtualRows> parts;
    for (const CataloguePart& part : catalogue_)
      if (part.series_rows > 0)
        parts.push_back({.file = part.file,
                         .dataset = "/" + path,
                         .shape = part.series_shape,
                         .first = part.first_series,
                         .rows = part.series_rows});
    file_.write_virtual<float>(path, all, parts, 0.0F);
  }
  Digest digest;
  std::vector<float> padded;
  for (std::size_t k = 0; k < series.index.size(); ++k) {
    const std::vector<float> pressure = series.pressure(k);
    const std::size_t length = series.shapes[k][axis] * inner;
    padded.assign(product(row), 0.0F);
    for (std::size_t line = 0; line < lines; ++line)
      std::copy_n(pressure.begin() + static_cast<std::ptrdiff_t>(line * length), length,
                  padded.begin() + static_cast<std::ptrdiff_t>(line * row[axis] * inner));
    if (catalogue_.empty()) file_.append<float>(path, padded);
    digest.add(std::span<const float>(padded));
  }
  note(path, all, digest.text());
}

void Writer::write_summary() {
  const Summary& summary = results_.summary;
  file_.make_group("summary");
  file_.set_attribute("summary", "confidence", summary.confidence);
  file_.set_attribute("summary", "proportion_interval", summary.proportion_interval);
  file_.set_attribute("summary", "intervals", summary.intervals);
  for (const SummaryTable& table : summary.tables) {
    const std::string group = "summary/" + table.name;
    file_.make_group(group);
    file_.set_attribute(group, "title", table.title);
    std::vector<std::string> order;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const std::string path = group + "/" + table.columns[i].name;
      file_.write<double>(path, table.values[i], {table.values[i].size()});
      describe_column(path, table.columns[i]);
      noted(path, table.values[i]);
      order.push_back(table.columns[i].name);
    }
    if (!order.empty()) file_.set_attribute(group, "columns", order);
  }
}

void Writer::write_manifest() {
  const Json manifest = {{"identity", results_.imprint.identity},
                         {"first", results_.range.first},
                         {"end", results_.range.end},
                         {"rows", results_.table.index.size()},
                         {"complete", results_.complete()},
                         {"columns", Json::parse(to_json(results_.imprint.columns))},
                         {"datasets", manifest_}};
  file_.write_text("manifest", manifest.dump());
  describe(file_, "manifest", "JSON: what the file is to hold, with SHA-256 of each dataset");
}

void Writer::write_run() {
  const auto& sessions = results_.sessions;
  std::string lines;
  double seconds = 0.0;
  for (const Session& session : sessions) {
    lines += to_json(session) + "\n";
    seconds += session.seconds;
  }
  file_.make_group("run");
  file_.write_text("run/sessions", lines);
  describe(file_, "run/sessions", "the runs that made the rows: a line of JSON each");
  file_.set_attribute("run", "seconds", seconds);
  const auto set = [&](const std::string& key,
                       const std::function<std::string(const Session&)>& text) {
    file_.set_attribute("run", key, joined(different(sessions, text)));
  };
  set("host", [](const Session& s) { return s.made.host; });
  set("cpu", [](const Session& s) { return s.made.cpu; });
  set("started", [](const Session& s) { return s.made.started; });
  set("threads", [](const Session& s) { return std::to_string(s.made.threads); });
  set("library_versions", [](const Session& s) { return s.made.library_versions; });
  const Table& table = results_.reuse;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string path = "run/reuse/" + table.columns[i].name;
    file_.write<double>(path, table.values[i], {table.values[i].size()});
    describe_column(path, table.columns[i]);
  }
}

/// What was written is on the disk, not on its way there: the journal goes once the file is there.
void synchronise(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw RunError(path.string() + ": " + std::strerror(errno));
  const bool done = fsync(file) == 0;
  const int error = errno;
  close(file);
  if (!done && error != EINVAL && error != EROFS)
    throw RunError(path.string() + ": " + std::strerror(error));
}

}  // namespace

void write_study_file(const std::filesystem::path& path, const StudyResults& results,
                      const SeriesSource& series, const std::vector<CataloguePart>& catalogue) {
  const std::filesystem::path part = path.string() + ".part";
  try {
    Writer(part, results, catalogue).write(series);
    synchronise(part);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw RunError(path.string() + ": renaming " + part.string() + ": " + error.message());
  synchronise(path.has_parent_path() ? path.parent_path() : ".");
}

}  // namespace asdic::study
