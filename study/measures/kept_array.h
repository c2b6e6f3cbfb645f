#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/ping/growing_table.h"
#include "processing/ping_processor.h"
#include "study/plan/measure_plan.h"

namespace asdic::detail::study {

struct ReceiverAnswers;

/// Numbers that a row keeps beside its columns: of one KeptKind.
struct KeptArray {
  std::string name;                  ///< of its kind
  std::vector<std::size_t> shape{};  ///< {lines, numbers of a line}
  std::vector<double> head{};        ///< [kind.head] numbers that tell of the whole
  std::vector<double> values{};      ///< [product of shape] row-major

  bool operator==(const KeptArray&) const = default;
};

using KeptColumn = GrowingTable::Column;

/// What arrays of a name are, and how they lie in a study's file: docs/formats/study-results.md.
struct KeptKind {
  enum class Layout {
    padded,  ///< one dataset of (row, line, number), lines padded to the longest with NaN
    ragged   ///< a dataset for each number of a line, the lines of all rows one after the other
  };
  std::string_view name;  ///< of the group, "spectra"
  Layout layout;
  KeptColumn count;  ///< how many numbers of a line (padded) or lines (ragged) a row has
  std::vector<KeptColumn> head;
  std::vector<KeptColumn> values;  ///< one of padded ones; of ragged ones of each number
  std::string_view line, number;   ///< what padded ones count along their axes, in words
  std::string_view line_says{}, number_says{};

  /// Which axis of an array varies from row to row.
  [[nodiscard]] std::size_t axis() const noexcept { return layout == Layout::padded ? 1 : 0; }
};

/// Every kind, in the order of files.
[[nodiscard]] std::span<const KeptKind> kept_kinds();
[[nodiscard]] const KeptKind& spectra_kind();
[[nodiscard]] const KeptKind& detections_kind();

/// The power spectral density of what an array received, [channels × frequencies] Pa²/Hz: of each
/// phone, or their mean (one channel).
/// \throws InputError naming the resolution that a record is too short for
[[nodiscard]] KeptArray kept_spectrum(const ArrayRecording& received, const SpectrumPlan& plan);

/// What the receiver detected, [detections × columns] in the order of time.
[[nodiscard]] KeptArray kept_detections(const ReceiverAnswers& answers);

}  // namespace asdic::detail::study
