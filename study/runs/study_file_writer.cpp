// The rows of a study's file, and the file as a whole.
#include "study/runs/study_file_writer.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/error.h"

namespace asdic::study {
namespace {

std::size_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

}  // namespace

void StudyFileWriter::write_table() {
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
  column<std::int64_t>("time_series/index", index, -1, true);
  describe(file_, "time_series/index", "realisation, counted from 0");
  file_.make_scale("time_series/index", "kept");
  column<std::int32_t>("time_series/valid_samples", samples, 0, true);
  describe(file_, "time_series/valid_samples", "samples before the padding");
  file_.attach_scales("time_series/valid_samples", {"time_series/index"});
  for (const SeriesDataset& dataset : series_datasets()) {
    const std::string path = std::string("time_series/") + dataset.name;
    std::vector<double> values;
    for (const SeriesTiming& timing : series.timing) values.push_back(timing.*dataset.value);
    column<double>(path, values, std::numeric_limits<double>::quiet_NaN(), true);
    describe(file_, path, dataset.meaning, dataset.unit);
    file_.attach_scales(path, {"time_series/index"});
  }
  write_pressure(series, row);
  describe(file_, "time_series/pressure", "what the phones hear; complex where the last axis is 2",
           "Pa");
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

void write_study_file(OutputFile& output, const StudyResults& results, const SeriesSource& series,
                      const std::vector<CataloguePart>& catalogue) {
  StudyFileWriter(output.part(), results, catalogue).write(series);
  output.finish();
}

}  // namespace asdic::study
