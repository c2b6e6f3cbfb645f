#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "io/files/output_file.h"
#include "io/hdf5/hdf5_file.h"
#include "study/journal/fingerprint.h"
#include "study/measures/kept_array.h"
#include "study/sampling/index_set.h"
#include "study/summary/summary.h"

// The file of a study, or of a part of one: docs/formats/study-results.md.
namespace asdic::detail::study {

/// All that such a file tells but the time series, which are too large to be held.
struct StudyResults {
  Fingerprint fingerprint{};
  IndexRange range{};        ///< that the file was to hold
  std::string stopped_by{};  ///< "--until 0.02": why it holds fewer than the study asks for
  Table table{};             ///< sorted by index; inputs and measures
  Table reuse{};             ///< columns that tell how rows were made, for /run
  std::vector<std::string> faults{};  ///< "17: why it was skipped", the first of them
  Summary summary{};
  std::vector<Session> sessions{};

  [[nodiscard]] bool complete() const noexcept { return table.index.size() == range.size(); }
};

inline constexpr std::size_t most_faults = 1000;  ///< that a file tells

/// The time series that were kept, as they are asked for one by one.
struct SeriesSource {
  std::vector<std::uint64_t> index{};  ///< [kept] of which realisations
  std::vector<Shape> shapes{};         ///< [kept] [channels × samples × iq]: samples may differ
  std::vector<SeriesTiming> timing{};  ///< [kept]
  /// The k-th of them; called once for each, in order.
  std::function<std::vector<float>(std::size_t k)> pressure{};
};

/// What tells of the arrays of a kind that were kept.
struct KeptHeads {
  std::vector<std::uint64_t> index{};        ///< [kept] of which realisations
  std::vector<Shape> shapes{};               ///< [kept]
  std::vector<std::vector<double>> heads{};  ///< [kept]
};

/// The arrays themselves, as they are asked for one by one.
struct KeptSource {
  const KeptKind* kind = nullptr;
  KeptHeads told{};
  /// The k-th of them; called once for each, in order.
  std::function<KeptArray(std::size_t k)> array{};
};

/// Rows of a dataset of a part that a catalogue shows.
struct PartRows {
  std::size_t first = 0, rows = 0;
  Shape shape{0};  ///< of the part's dataset
};

/// Where the rows of a catalogue lie: file and its rows, in the order of the catalogue.
struct CataloguePart {
  std::filesystem::path file;  ///< relative to the catalogue's folder
  PartRows table{};            ///< of the part's /index
  PartRows series{};           ///< of the part's /time_series/pressure
  struct Kept {
    PartRows heads{};   ///< of a kind's /index
    PartRows values{};  ///< of its values
  };
  std::vector<Kept> kept{};  ///< [kept_kinds()]
};

/// Writes a part and gives it its name when it is whole.
/// \param kept       [kept_kinds()]
/// \param catalogue  empty: all data are in the file; else its table, time series and what else
/// was kept show those of the parts
/// \throws RunError
void write_study_file(OutputFile& output, const StudyResults& results, const SeriesSource& series,
                      const std::vector<KeptSource>& kept,
                      const std::vector<CataloguePart>& catalogue = {});

/// A file of a study, opened.
class StudyFile {
 public:
  /// \throws InputError for what is no such file: another file, a truncated one, another version
  explicit StudyFile(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return file_.path(); }
  [[nodiscard]] const Fingerprint& fingerprint() const noexcept { return fingerprint_; }
  [[nodiscard]] IndexRange range() const noexcept { return range_; }
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  [[nodiscard]] std::string stopped_by() const;
  [[nodiscard]] std::vector<Session> sessions() const;
  [[nodiscard]] std::vector<std::string> faults() const;
  [[nodiscard]] std::vector<std::uint64_t> index() const;
  [[nodiscard]] Table table() const;
  [[nodiscard]] Table own() const;       ///< columns of [summary.own] alone
  [[nodiscard]] CellSums cells() const;  ///< of all its rows; empty where none are counted
  [[nodiscard]] std::vector<std::uint64_t> series_index() const;
  [[nodiscard]] Shape series_shape() const;  ///< of /time_series/pressure; {} if there is none
  [[nodiscard]] std::vector<std::int32_t> series_samples() const;
  /// [kept]; NaN in files of version 1.0, which do not tell it
  [[nodiscard]] std::vector<SeriesTiming> series_timing() const;
  /// The k-th of them, [channels × its own samples × iq].
  [[nodiscard]] std::vector<float> series(std::size_t k) const;

  /// Of a kind; empty where none are kept.
  [[nodiscard]] KeptHeads kept_heads(const KeptKind& kind) const;
  /// Of the dataset that holds its values: of padded ones, or of the first number of ragged ones.
  [[nodiscard]] Shape kept_shape(const KeptKind& kind) const;
  /// Where the rows of a catalogue lie; {} for a file that holds its own.
  [[nodiscard]] std::vector<std::filesystem::path> parts() const;
  /// \throws InputError naming the first part that is not there: HDF5 would show nothing instead
  void check_parts() const;
  /// Compares every dataset with its SHA-256 in the manifest.
  /// \throws InputError naming the first that differs, or is not there; of a catalogue, the part
  /// that is gone or has changed
  void verify() const;

  [[nodiscard]] const Hdf5File& file() const noexcept { return file_; }

 private:
  void check_each_part() const;

  Hdf5File file_;
  Fingerprint fingerprint_;
  IndexRange range_;
  bool complete_ = false;
  std::string manifest_;
};

/// The arrays of a kind in a file, one by one: those that follow one another are read together.
class KeptReader {
 public:
  /// \param file  outlives it   \throws InputError where counts and values do not fit together
  KeptReader(const StudyFile& file, const KeptKind& kind);
  [[nodiscard]] const KeptHeads& told() const noexcept { return told_; }
  [[nodiscard]] KeptArray at(std::size_t k);
  /// Of ragged ones: the line before which the k-th begins.
  [[nodiscard]] std::size_t first_line(std::size_t k) const { return first_line_.at(k); }

 private:
  void read_lines(std::size_t k);

  const StudyFile& file_;
  const KeptKind& kind_;
  KeptHeads told_;
  std::vector<std::size_t> first_line_;     // [kept + 1] of ragged ones
  std::size_t first_ = 0, end_ = 0;         // lines that are in hand
  std::vector<std::vector<double>> lines_;  // [numbers] of ragged ones
};

/// A dataset of /time_series that has a number for each: how to read its samples.
struct SeriesDataset {
  const char *name, *unit, *meaning;
  double SeriesTiming::*value;
};
[[nodiscard]] std::span<const SeriesDataset> series_datasets();

/// Which axis of a time series counts its samples.
[[nodiscard]] inline std::size_t sample_axis(const Shape& shape) noexcept {
  return shape.size() < 2 ? 0 : 1;
}

}  // namespace asdic::detail::study
