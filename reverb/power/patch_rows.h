#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "reverb/fields/scattering_field.h"
#include "reverb/power/patch_row.h"

namespace asdic::detail {

/// The patches as rows of the file; {rows, every}: each every-th ring is kept.
struct PatchRows {
  std::vector<PatchRow> rows;
  int every = 1;
};

/// What comes back from the middles of cells, pair by pair. \param limits  what is too faint
/// \param source_level_db  [dB re 1 µPa at 1 m]   \param most  rows
[[nodiscard]] PatchRows patch_rows(std::span<const ScatteringField> fields,
                                   const AudibleLimits& limits, double source_level_db,
                                   std::size_t most);

}  // namespace asdic::detail
