#pragma once
#include <vector>

#include "raytrace/layered/branch_table.h"

namespace asdic::detail::support {

/// The intervals of a fan whose rays come no further than this, in order. \param furthest  [m]
inline std::vector<const FanInterval*> fan_intervals(const BranchTable& table, double furthest) {
  std::vector<const FanInterval*> all;
  table.for_each_piece(0.0, furthest, [&](const MonotonePiece& piece) {
    if (all.empty() || all.back() != piece.interval) all.push_back(piece.interval);
  });
  return all;
}

}  // namespace asdic::detail::support
