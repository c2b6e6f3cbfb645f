#pragma once
#include <string>
#include <vector>

#include "io/ping/growing_table.h"
#include "io/processing/results.h"

namespace asdic::detail::processing {

/// A table of results, for HDF5 and CSV alike.
struct Table {
  std::vector<GrowingTable::Column> columns;
  std::vector<std::vector<double>> rows;
};

/// Of a detection, whichever ping and array it is of, and what they hold of one.
/// \param owner  as PingScore tells
[[nodiscard]] std::vector<GrowingTable::Column> detection_columns();
[[nodiscard]] std::vector<double> detection_row(const Detection& detection, int owner);

[[nodiscard]] Table detections_table(const ProcessedRun& run);
[[nodiscard]] Table tracks_table(const ProcessedRun& run);
[[nodiscard]] Table targets_table(const ProcessedRun& run);

}  // namespace asdic::detail::processing
