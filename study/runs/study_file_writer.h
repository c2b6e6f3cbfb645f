#pragma once
#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "io/files/digest.h"
#include "io/hdf5/scale.h"
#include "study/runs/study_file.h"

// Inside of write_study_file(), for its own .cpp files.
namespace asdic::detail::study {

/// Writes the parts of a study's file one after the other, and notes each in the manifest.
class StudyFileWriter {
 public:
  StudyFileWriter(const std::filesystem::path& path, const StudyResults& results,
                  const std::vector<CataloguePart>& catalogue)
      : file_(Hdf5File::create(path)), results_(results), catalogue_(catalogue) {}

  void write(const SeriesSource& series, const std::vector<KeptSource>& kept) {
    write_root();
    write_table();
    write_cells();
    write_series(series);
    for (std::size_t kind = 0; kind < kept.size(); ++kind) write_kept(kind, kept[kind]);
    write_summary();
    write_laws();
    write_manifest();
    write_run();
    file_.close();
  }

 private:
  void write_root();
  void write_table();
  void write_cells();
  void write_series(const SeriesSource& series);
  void write_kept(std::size_t kind, const KeptSource& kept);
  void write_padded(std::size_t kind, const KeptSource& kept);
  void write_ragged(std::size_t kind, const KeptSource& kept);
  void write_summary();
  void write_laws();
  void write_manifest();
  void write_run();
  void write_pressure(const SeriesSource& series, const Shape& row);

  /// Notes a dataset in the manifest.
  void note(const std::string& dataset, const Shape& shape, const std::string& sha256) {
    noted_[dataset] = {.shape = shape, .sha256 = sha256};
  }

  /// Which of a part's rows a dataset shows.
  using RowsOf = std::function<PartRows(const CataloguePart& part)>;
  [[nodiscard]] std::vector<VirtualRows> shown(const std::string& dataset, const RowsOf& of) const {
    std::vector<VirtualRows> parts;
    for (const CataloguePart& part : catalogue_) {
      PartRows rows = of(part);
      if (rows.rows > 0)
        parts.push_back({.file = part.file,
                         .dataset = "/" + dataset,
                         .shape = std::move(rows.shape),
                         .first = rows.first,
                         .rows = rows.rows});
    }
    return parts;
  }

  /// A column, here or in the parts. \param of  of which rows of the parts; of one column
  template <class T>
  void column(
      const std::string& dataset, std::span<const T> values, T fill,
      const RowsOf& of = [](const CataloguePart& part) { return part.table; }) {
    const Shape shape{values.size()};
    if (catalogue_.empty())
      file_.write<T>(dataset, values, shape);
    else
      file_.write_virtual<T>(dataset, shape, shown(dataset, of), fill);
    noted<T>(dataset, values);
  }

  template <class T>
  void noted(const std::string& dataset, const std::vector<T>& values) {
    noted<T>(dataset, std::span<const T>(values));
  }
  template <class T>
  void noted(const std::string& dataset, std::span<const T> values) {
    Digest digest;
    digest.add(values);
    note(dataset, {values.size()}, digest.text());
  }

  void text(const std::string& dataset, const std::string& value, const std::string& long_name) {
    file_.write_text(dataset, value);
    describe(file_, dataset, long_name);
    Digest digest;
    digest.add(std::span<const char>(value));
    note(dataset, {}, digest.text());
  }

  Hdf5File file_;
  const StudyResults& results_;
  const std::vector<CataloguePart>& catalogue_;
  struct Dataset {
    Shape shape;
    std::string sha256;
  };
  std::map<std::string, Dataset> noted_;
};

}  // namespace asdic::detail::study
