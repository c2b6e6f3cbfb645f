#include "study/runs/study_file_writer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "core/error.h"
#include "study/runs/summary_writer.h"

// The rows of a study's file, and the file as a whole.
namespace asdic::detail::study {

namespace {

std::size_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

}  // namespace

void StudyFileWriter::write_table() {
  const Table& table = results_.table;
  // HDF5 has no unsigned ones among ours. Indices are far below 2⁶³, and valid is 0 or 1: their
  // bytes are those of the signed type, as which they may be read.
  const std::span<const std::int64_t> index(
      reinterpret_cast<const std::int64_t*>(table.index.data()), table.index.size());
  const std::span<const std::int8_t> valid(reinterpret_cast<const std::int8_t*>(table.valid.data()),
                                           table.valid.size());
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
    column<double>(path, table.values[i].span(), std::numeric_limits<double>::quiet_NaN());
    table.values[i].rest();
    describe_column(file_, path, c);
    file_.set_attribute(path, "role",
                        c.role == Column::Role::input    ? "input"
                        : c.role == Column::Role::weight ? "weight"
                        : c.role == Column::Role::ping   ? "ping"
                                                         : "measure");
    file_.attach_scales(path, {"index"});
  }
  // Of a catalogue too: they are made of its rows, not of the parts'.
  const Table& own = results_.summary.own;
  for (std::size_t i = 0; i < own.columns.size(); ++i) {
    const Column& c = own.columns[i];
    const std::string path = "table/" + c.name;
    file_.write<double>(path, own.values[i].span(), {own.values[i].size()});
    noted(path, own.values[i].span());
    describe_column(file_, path, c);
    file_.set_attribute(path, "role", "measure");
    file_.set_attribute(path, "formula", c.formula);
    if (c.event) file_.set_attribute(path, "event", std::int64_t{1});
    file_.attach_scales(path, {"index"});
  }
  std::string faults;
  for (const std::string& fault : results_.faults) faults += fault + "\n";
  text("faults", faults, "why realisations were skipped, \"index: reason\" a line, the first 1000");
}

/// Sums over all rows: of a catalogue too, it has them itself.
void StudyFileWriter::write_cells() {
  const CellSums& sums = results_.table.cells;
  if (sums.empty()) return;
  const std::size_t targets = sums.shape.targets, times = sums.shape.times() + 1,
                    levels = sums.shape.levels.size();
  const std::vector<double>& edges = sums.shape.edges;
  file_.make_group("cells");
  file_.write<double>("cells/level", sums.shape.levels, {levels});
  describe(file_, "cells/level",
           "-ln P of even Rayleigh noise: lower end of a level, the next one's is its upper", "1");
  file_.make_scale("cells/level", "level");
  noted("cells/level", sums.shape.levels);
  file_.make_dimension("cells/target", targets);
  describe(file_, "cells/target", "no values: target of the scenario, from 0");
  file_.make_dimension("cells/time", times);
  describe(file_, "cells/time", "no values: 0 all times, then the bins");
  std::vector<double> low{edges.front()}, high{edges.back()};
  low.insert(low.end(), edges.begin(), edges.end() - 1);
  high.insert(high.end(), edges.begin() + 1, edges.end());
  const auto ends = [&](const std::string& name, const std::vector<double>& values) {
    file_.write<double>("cells/" + name, values, {times});
    describe(file_, "cells/" + name,
             name == "time_low" ? "least of the bin, after the ping"
                                : "greatest of the bin, after the ping",
             "s");
    file_.attach_scales("cells/" + name, {"cells/time"});
    noted("cells/" + name, values);
  };
  ends("time_low", low);
  ends("time_high", high);
  const auto numbers = [&](const std::string& name, const std::vector<std::int64_t>& values,
                           const Shape& shape, const std::string& meaning) {
    const std::string path = "cells/" + name;
    file_.write<std::int64_t>(path, values, shape);
    describe(file_, path, meaning);
    std::vector<std::string> scales{"cells/target", "cells/time"};
    if (shape.size() > 2) scales.emplace_back("cells/level");
    file_.attach_scales(path, scales);
    file_.set_attribute(path, "coordinates", "time_low time_high");
    Digest digest;
    digest.add(std::span<const std::int64_t>(values));
    note(path, shape, digest.text());
  };
  const Shape all{targets, times, levels};
  numbers("count", sums.count, all, "cells without an echo in the level, of all realisations");
  numbers("squares", sums.squares, all,
          "sum over realisations of the square of its cells at or above the level");
  numbers("with_all", sums.with_all, all,
          "sum over realisations of its cells at or above the level times all of its cells");
  numbers("realisations", sums.realisations, {targets, times}, "that have a cell there");
}

void StudyFileWriter::write_series(const SeriesSource& series) {
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
  const auto of = [](const CataloguePart& part) {
    return PartRows{part.series.first, part.series.rows, {part.series.shape.at(0)}};
  };
  column<std::int64_t>("time_series/index", index, -1, of);
  describe(file_, "time_series/index", "realisation, counted from 0");
  file_.make_scale("time_series/index", "kept");
  column<std::int32_t>("time_series/valid_samples", samples, 0, of);
  describe(file_, "time_series/valid_samples", "samples before the padding");
  file_.attach_scales("time_series/valid_samples", {"time_series/index"});
  for (const SeriesDataset& dataset : series_datasets()) {
    const std::string path = std::string("time_series/") + dataset.name;
    std::vector<double> values;
    for (const SeriesTiming& timing : series.timing) values.push_back(timing.*dataset.value);
    column<double>(path, values, std::numeric_limits<double>::quiet_NaN(), of);
    describe(file_, path, dataset.meaning, dataset.unit);
    file_.attach_scales(path, {"time_series/index"});
  }
  write_pressure(series, row);
  describe(file_, "time_series/pressure",
           "what the phones receive; complex where the last axis is 2", "Pa");
  const std::vector<std::pair<const char*, const char*>> all{
      {"channel", "no values: number of the phone, from 0"},
      {"sample", "no values: number k is at start + k / sample_rate"},
      {"iq", "no values: 0 real part, 1 imaginary part"}};
  std::vector<std::string> scales{"time_series/index"};
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto& [name, meaning] = all.at(row.size() == 1 ? 1 : i);
    scales.push_back(std::string("time_series/") + name);
    file_.make_dimension(scales.back(), row[i]);
    describe(file_, scales.back(), meaning);
  }
  file_.attach_scales("time_series/pressure", scales);
}

/// The time series one by one: they are never held together.
void StudyFileWriter::write_pressure(const SeriesSource& series, const Shape& row) {
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
    const auto of = [](const CataloguePart& part) { return part.series; };
    file_.write_virtual<float>(path, all, shown(path, of), 0.0F);
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

void write_study_file(OutputFile& output, const StudyResults& results, const SeriesSource& series,
                      const std::vector<KeptSource>& kept,
                      const std::vector<CataloguePart>& catalogue) {
  StudyFileWriter(output.part(), results, catalogue).write(series, kept);
  output.finish();
}

// What a study's file says of itself: its root, summary, manifest, and how it came about.

namespace {

using Json = nlohmann::json;

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

}  // namespace

void StudyFileWriter::write_root() {
  const Fingerprint& fingerprint = results_.fingerprint;
  write_filetype(file_, "asdic study", "1.6");
  file_.set_attribute("", "title", fingerprint.title);
  file_.set_attribute("", "identity", fingerprint.identity);
  file_.set_attribute("", "seed", std::to_string(fingerprint.seed));
  file_.set_attribute("", "design", fingerprint.design);
  file_.set_attribute("", "realisations", static_cast<std::int64_t>(fingerprint.realisations));
  file_.set_attribute("", "complete", std::int64_t{results_.complete()});
  if (!results_.stopped_by.empty()) file_.set_attribute("", "stopped_by", results_.stopped_by);
  if (!fingerprint.overrides.empty()) file_.set_attribute("", "overrides", fingerprint.overrides);
  if (!fingerprint.warnings.empty()) file_.set_attribute("", "warnings", fingerprint.warnings);
  if (std::isfinite(fingerprint.left_out_db))
    file_.set_attribute("", "left_out_db", fingerprint.left_out_db);
  file_.set_attribute("", "lasting_scatterers",
                      "as those of one ping (but with a texture, several arrays or "
                      "reverberation.synthesis = \"scatterers\")");
  const auto& sessions = results_.sessions;
  const auto version = [](const Session& s) { return s.made.program_version; };
  const auto build = [](const Session& s) { return s.made.build; };
  file_.set_attribute("", "program_version", joined(different(sessions, version)));
  file_.set_attribute("", "build", joined(different(sessions, build)));
  write_origin(file_, fingerprint.origin);
  text("study", fingerprint.text, "the study file, verbatim");
  text("scenario", fingerprint.scenario_text, "the scenario file, verbatim");
}

void StudyFileWriter::write_summary() {
  study::write_summary(file_, results_.summary,
                       [&](const std::string& dataset, const std::vector<double>& values) {
                         noted(dataset, values);
                       });
}

/// laws/COLUMN, and laws/COLUMN/caseK of one that looks at another input.
void StudyFileWriter::write_laws() {
  file_.make_group("laws");
  std::string of;
  std::size_t cases = 0;
  for (const LawTable& table : results_.summary.laws) {
    if (table.given.empty() || table.column != of) cases = 0;
    of = table.column;
    std::string group = "laws/" + table.column;
    if (!table.given.empty()) group += "/case" + std::to_string(cases++);
    file_.make_group(group);
    file_.set_attribute(group, "law", table.law);
    file_.set_attribute(group, "how", table.how);
    if (!table.given.empty()) file_.set_attribute(group, "given", table.given);
    if (table.value.empty()) continue;
    const Column column{
        .name = table.column, .unit = table.unit, .meaning = table.meaning, .labels = table.labels};
    const std::string value = group + "/value";
    file_.write<double>(value, table.value, {table.value.size()});
    describe_column(file_, value, column);
    file_.make_scale(value, "value");
    noted(value, table.value);
    const auto write = [&](const char* name, const std::vector<double>& values,
                           const char* long_name, const std::string& unit) {
      const std::string path = group + '/' + name;
      file_.write<double>(path, values, {values.size()});
      describe(file_, path, long_name, unit);
      file_.attach_scales(path, {value});
      noted(path, values);
    };
    const std::string unit = table.unit.substr(0, table.unit.find(" re "));
    if (table.discrete)
      write("probability", table.share, "probability of the value", "1");
    else
      write("density", table.share, "probability density", unit == "1" ? "1" : '(' + unit + ")-1");
    write("cumulative", table.cumulative, "probability of the value or less", "1");
  }
  for (const RowDensity& one : results_.summary.densities) {
    const std::string path = "laws/" + one.column + "/density_of_row",
                      unit = one.unit.substr(0, one.unit.find(" re "));
    file_.write<double>(path, one.density, {one.density.size()});
    describe(file_, path, "probability density of what the row drew, given its other inputs",
             unit == "1" ? "1" : '(' + unit + ")-1");
    file_.attach_scales(path, {"index"});
    noted(path, one.density);
  }
}

void StudyFileWriter::write_manifest() {
  Json datasets = Json::object();
  for (const auto& [name, noted] : noted_)
    datasets[name] = {{"shape", noted.shape}, {"sha256", noted.sha256}};
  Json manifest = {{"identity", results_.fingerprint.identity},
                   {"first", results_.range.first},
                   {"end", results_.range.end},
                   {"rows", results_.table.index.size()},
                   {"complete", results_.complete()},
                   {"columns", Json::parse(to_json(results_.fingerprint.columns))},
                   {"datasets", datasets}};
  if (!results_.summary.own.columns.empty())
    manifest["own"] = Json::parse(to_json(results_.summary.own.columns));
  file_.write_text("manifest", manifest.dump());
  describe(file_, "manifest", "JSON: what the file is to hold, with SHA-256 of each dataset");
}

void StudyFileWriter::write_run() {
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
  if (!table.columns.empty()) file_.make_group("run/reuse");
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string path = "run/reuse/" + table.columns[i].name;
    file_.write<double>(path, table.values[i].span(), {table.values[i].size()});
    table.values[i].rest();
    describe_column(file_, path, table.columns[i]);
    file_.attach_scales(path, {"index"});
  }
}

}  // namespace asdic::detail::study
